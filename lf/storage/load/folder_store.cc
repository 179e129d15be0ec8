// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/folder_store.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "lf/core/file.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/picture_view.h"
#include "lf/pixels/files/reduced_jpeg.h"
#include "lf/storage/load/image_reading.h"
#include "lf/storage/load/load_mosaics.h"
#include "lf/storage/load/opacities.h"
#include "lf/storage/load/reduced_reading.h"

namespace lf {
namespace fs = std::filesystem;

FolderStore::FolderStore(const LightField& light_field, Mosaics mosaics)
    : light_field_(light_field), tables_(light_field.encoding, ChannelGains()), mosaics_(mosaics) {}

FolderStore::~FolderStore() {
  if (light_field_.size() > 0 && PictureViewOf(light_field_.ImagePath({0}))) ForgetSharedPicture();
}

bool FolderStore::IsThere(LfImageId id) const {
  std::error_code error;
  return fs::exists(ImageFileOf(light_field_, id), error);
}

void FolderStore::Announce(LfImageId id) const { AnnounceRead(ImageFileOf(light_field_, id)); }

Result<void> FolderStore::Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const {
  return LoadByRows(id, rect, pixels, nullptr);
}

Result<void> FolderStore::LoadByRows(LfImageId id, const PixelRect& rect, LfPixels* pixels,
                                     const RowsLoaded& rows_loaded) const {
  std::unique_ptr<Loading> loading = TakeLoading();
  const Result<void> loaded = LoadBy(loading.get(), id, rect, rows_loaded, pixels);
  GiveBack(std::move(loading));
  return loaded;
}

Result<int> FolderStore::LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                                     LfPixels* pixels) const {
  std::unique_ptr<Loading> loading = TakeLoading();
  const Result<int> reduced = LoadReducedBy(loading.get(), id, divisor, pixels);
  GiveBack(std::move(loading));
  if (!reduced || *reduced > 1) return reduced;
  return LfImageStore::LoadReduced(id, divisor, k, pixels);
}

// Returns 1, without loading pixels, if the LF image cannot be reduced.
Result<int> FolderStore::LoadReducedBy(Loading* loading, LfImageId id, int divisor,
                                       LfPixels* pixels) const {
  LF_CHECK(id.value < light_field_.size());
  if (!light_field_.mask_names.empty() && !light_field_.mask_names[id.value].empty()) return 1;
  const fs::path path = light_field_.ImagePath(id);
  const auto read = [&path](const WantedReduction& wanted, ImagePart* part) {
    return ReadReducedJpeg(path, wanted, part);
  };
  return LoadReducedFile(read, path.string(), light_field_, id, divisor, tables_, &loading->part,
                         pixels);
}

Result<void> FolderStore::LoadBy(Loading* loading, LfImageId id, const PixelRect& rect,
                                 const RowsLoaded& rows_loaded, LfPixels* pixels) const {
  LF_CHECK(id.value < light_field_.size());
  // No row of RGB is complete before the whole mosaic is demosaicked.
  const bool converts =
      mosaics_ == Mosaics::kToRgb && light_field_.encoding.bayer != BayerPattern::kNone;
  LF_RETURN_IF_ERROR(LoadMosaicsAs(
      mosaics_, light_field_, id, rect,
      [&](const PixelRect& recorded, LfPixels* into) {
        return LoadRecorded(&loading->part, id, recorded, converts ? RowsLoaded() : rows_loaded,
                            into);
      },
      &loading->mosaic, pixels));
  if (converts && rows_loaded) rows_loaded(pixels, pixels->radiance.height());
  return {};
}

// Returns true if pixels of the LF image may be masked other than by its own alpha.
bool FolderStore::MayMask(LfImageId id) const {
  const LfCamera& camera = light_field_.cameras[id.value];
  return camera.masks_clipped || camera.brighter != LfCamera::kNone ||
         (!light_field_.mask_names.empty() && !light_field_.mask_names[id.value].empty());
}

Result<void> FolderStore::LoadRecorded(ImagePart* part, LfImageId id, const PixelRect& rect,
                                       const RowsLoaded& rows_loaded, LfPixels* pixels) const {
  const RadianceEncoding& encoding = light_field_.encoding;
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& intrinsics = light_field_.intrinsics[camera.intrinsics_index];
  const PixelRect inside = Intersection(rect, {0, 0, intrinsics.width_px, intrinsics.height_px});
  const PixelRect wanted = inside.empty() ? PixelRect{0, 0, 1, 1} : inside;
  LF_ASSIGN_OR_RETURN(const ChannelUse use, ReadStoredPixels(light_field_, id, wanted, part));
  pixels->Reset(inside, encoding.bayer);
  // Rows are complete once they are converted, unless masks or opacities follow.
  const bool is_by_rows =
      rows_loaded && !use.alpha && !MayMask(id) && !encoding.HasOpacity() && !inside.empty();
  RowsDone rows_done;
  if (is_by_rows) rows_done = [&](int row_count) { rows_loaded(pixels, row_count); };
  ConvertRadiance(*part, use.colours, tables_, encoding, camera, intrinsics, pixels, rows_done);
  if (is_by_rows) return {};
  if (use.alpha && encoding.AlphaIsLight()) {
    LF_ASSIGN_OR_RETURN(const Image<uint16_t> opacities,
                        ReadOpacities(light_field_, id, *part, use, inside));
    ComposeWithBackground(opacities, inside, encoding, pixels);
  } else {
    LF_RETURN_IF_ERROR(ForEachMasked(light_field_, id, *part, use, inside, [&](int x, int y) {
      pixels->Mask(x - inside.x_begin, y - inside.y_begin);
    }));
    if (encoding.HasOpacity()) SetOpaque(pixels);
  }
  if (rows_loaded) rows_loaded(pixels, pixels->radiance.height());
  return {};
}

uint64_t FolderStore::StoredBytes(LfImageId id) const {
  std::error_code error;
  const uint64_t size = fs::file_size(ImageFileOf(light_field_, id), error);
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
