#include "lf/storage/load/folder_store.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/storage/load/image_reading.h"
#include "lf/storage/load/load_mosaics.h"
#include "lf/storage/load/opacities.h"

namespace lf {
namespace fs = std::filesystem;

FolderStore::FolderStore(const LightField& light_field, Mosaics mosaics)
    : light_field_(light_field), tables_(light_field.encoding, ChannelGains()), mosaics_(mosaics) {}

bool FolderStore::IsThere(LfImageId id) const {
  std::error_code error;
  return fs::exists(light_field_.ImagePath(id), error);
}

void FolderStore::Announce(LfImageId id) const { AnnounceRead(light_field_.ImagePath(id)); }

Result<void> FolderStore::Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const {
  std::unique_ptr<Loading> loading = TakeLoading();
  const Result<void> loaded = LoadBy(loading.get(), id, rect, pixels);
  GiveBack(std::move(loading));
  return loaded;
}

Result<void> FolderStore::LoadBy(Loading* loading, LfImageId id, const PixelRect& rect,
                                 LfPixels* pixels) const {
  LF_CHECK(id.value < light_field_.size());
  return LoadMosaicsAs(
      mosaics_, light_field_, id, rect,
      [&](const PixelRect& recorded, LfPixels* into) {
        return LoadRecorded(&loading->part, id, recorded, into);
      },
      &loading->mosaic, pixels);
}

Result<void> FolderStore::LoadRecorded(ImagePart* part, LfImageId id, const PixelRect& rect,
                                       LfPixels* pixels) const {
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& intrinsics = light_field_.intrinsics[camera.intrinsics_index];
  const PixelRect inside = Intersection(rect, {0, 0, intrinsics.width_px, intrinsics.height_px});
  const PixelRect wanted = inside.empty() ? PixelRect{0, 0, 1, 1} : inside;
  LF_ASSIGN_OR_RETURN(const ChannelUse use, ReadStoredPixels(light_field_, id, wanted, part));
  pixels->Reset(inside, light_field_.encoding.bayer);
  ConvertRadiance(*part, use.colours, tables_, light_field_.encoding, camera, intrinsics, pixels);
  if (use.alpha && light_field_.encoding.AlphaIsLight()) {
    LF_ASSIGN_OR_RETURN(const Image<uint16_t> opacities,
                        ReadOpacities(light_field_, id, *part, use, inside));
    ComposeWithBackground(opacities, inside, light_field_.encoding, pixels);
    return {};
  }
  LF_RETURN_IF_ERROR(ForEachMasked(light_field_, id, *part, use, inside, [&](int x, int y) {
    pixels->Mask(x - inside.x_begin, y - inside.y_begin);
  }));
  if (light_field_.encoding.HasOpacity()) SetOpaque(pixels);
  return {};
}

uint64_t FolderStore::StoredBytes(LfImageId id) const {
  std::error_code error;
  const uint64_t size = fs::file_size(light_field_.ImagePath(id), error);
  return error ? 0 : size;
}

std::unique_ptr<FolderStore::Loading> FolderStore::TakeLoading() const {
  const std::lock_guard lock(mutex_);
  if (loadings_.empty()) return std::make_unique<Loading>();
  std::unique_ptr<Loading> loading = std::move(loadings_.back());
  loadings_.pop_back();
  return loading;
}

void FolderStore::GiveBack(std::unique_ptr<Loading> loading) const {
  const std::lock_guard lock(mutex_);
  loadings_.push_back(std::move(loading));
}

}  // namespace lf
