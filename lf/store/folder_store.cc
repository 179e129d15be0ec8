#include "lf/store/folder_store.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "lf/capture/image_fit.h"
#include "lf/core/file.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/upright.h"
#include "lf/store/demosaic.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Which channels of a file are what.
struct ChannelUse {
  int channels = 1;
  int colours = 1;  // 1: grey or mosaic; 3: R, G, B; they come first
  std::optional<int> alpha;
};

// With or without a layer of an EXR file before it.
bool IsAlpha(const std::string& channel_name) {
  const std::string name = channel_name.substr(channel_name.rfind('.') + 1);
  return name == "A" || name == "alpha" || name == "Alpha";
}

ChannelUse UseOf(const ImageFileInfo& info) {
  ChannelUse use;
  use.channels = info.channels;
  use.colours = use.channels >= 3 ? 3 : 1;
  if (use.channels > use.colours && IsAlpha(info.channel_names[use.colours]))
    use.alpha = use.colours;
  return use;
}

// At least the pixels `rect` of the picture that the calibration is of, and where they lie in it.
Result<void> ReadFitting(const fs::path& path, bool is_mosaic, const Intrinsics& intrinsics,
                         const PixelRect& rect, ImagePart* part) {
  bool is_turned = false;
  const auto wanted = [&](const ImageFileInfo& info) -> Result<PixelRect> {
    LF_ASSIGN_OR_RETURN(const ImageFit fit,
                        FitToCalibration(info, is_mosaic, intrinsics, path.string()));
    is_turned = fit == ImageFit::kTurned;
    return is_turned ? StoredRect(rect, info.width, info.height, info.orientation) : rect;
  };
  LF_RETURN_IF_ERROR(ReadImagePart(path, wanted, part));
  if (!is_turned) return {};
  const ImageFileInfo& info = part->info;
  std::visit([&](auto& image) { image = Upright(image, info.orientation); }, part->image);
  part->rect = UprightRect(part->rect, info.width, info.height, info.orientation);
  return {};
}

// A raw file in a light field of anything else would show its mosaic as a grey picture.
Result<void> CheckRaw(const RawFacts& raw, const RadianceEncoding& encoding, const fs::path& path) {
  if (encoding.bayer == BayerPattern::kNone)
    return InputError(
        fmt::format("{}: is a camera raw file, but the light field states no lf_bayer: raw files "
                    "and other images do not go together",
                    path.string()));
  if (raw.bayer != BayerPattern::kNone && raw.bayer != encoding.bayer)
    return InputError(fmt::format("{}: its mosaic is {}, but that of the light field is {}",
                                  path.string(), NameOf(raw.bayer), NameOf(encoding.bayer)));
  return {};
}

Result<void> CheckEncoding(const ImagePart& file, const RadianceEncoding& encoding,
                           const fs::path& path) {
  if (file.info.raw) LF_RETURN_IF_ERROR(CheckRaw(*file.info.raw, encoding, path));
  if (encoding.bayer != BayerPattern::kNone && file.info.channels != 1)
    return InputError(
        fmt::format("{}: has {} channels, but lf_bayer says that it is a mosaic of one",
                    path.string(), file.info.channels));
  if (std::holds_alternative<Image<float>>(file.image)) return {};
  const int bits = std::holds_alternative<Image<uint8_t>>(file.image) ? 8 : 16;
  if (!LevelsFit(encoding, bits))
    return InputError(fmt::format(
        "{}: holds values of {} bits, which lf_black_level {} and lf_white_level {} do not fit",
        path.string(), bits, encoding.black_level,
        encoding.white_level ? fmt::format("{}", *encoding.white_level) : "(none)"));
  return {};
}

// Masks the pixels whose stored value, of `channel`, is not what is_kept(value) asks for.
template <class T, class IsKept>
void MaskByChannel(const Image<T>& stored, const PixelRect& stored_rect, int channel,
                   const IsKept& is_kept, LfPixels* pixels) {
  const PixelRect& rect = pixels->rect;
  LF_CHECK(Intersection(rect, stored_rect) == rect);
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const T* value = stored.row(y - stored_rect.y_begin) +
                     static_cast<size_t>(rect.x_begin - stored_rect.x_begin) * stored.channels() +
                     channel;
    for (int x = rect.x_begin; x < rect.x_end; ++x, value += stored.channels())
      if (!is_kept(*value)) pixels->Mask(x - rect.x_begin, y - rect.y_begin);
  }
}

void MaskTransparent(const ImagePart& part, int alpha, LfPixels* pixels) {
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        constexpr double kOpaque = std::is_floating_point_v<T> ? 1 : std::numeric_limits<T>::max();
        MaskByChannel(
            stored, part.rect, alpha, [](T value) { return value >= kOpaque / 2; }, pixels);
      },
      part.image);
}

Result<void> ApplyMaskFile(const fs::path& path, const Intrinsics& intrinsics, LfPixels* pixels) {
  if (pixels->rect.empty()) return {};
  ImagePart mask;
  LF_RETURN_IF_ERROR(ReadFitting(path, false, intrinsics, pixels->rect, &mask));
  std::visit(
      [&]<class T>(const Image<T>& stored) {
        MaskByChannel(
            stored, mask.rect, 0, [](T value) { return value != 0; }, pixels);
      },
      mask.image);
  return {};
}

}  // namespace

FolderStore::FolderStore(const LightField& light_field, Mosaics mosaics)
    : light_field_(light_field), tables_(light_field.encoding, 1), mosaics_(mosaics) {}

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
  const bool is_mosaic = light_field_.encoding.bayer != BayerPattern::kNone;
  if (!is_mosaic || mosaics_ == Mosaics::kAsRecorded)
    return LoadRecorded(&loading->part, id, rect, pixels);
  const Intrinsics& k = light_field_.intrinsics[light_field_.cameras[id.value].intrinsics_index];
  if (k.width_px < 2 || k.height_px < 2)
    return InputError(fmt::format("{}: is {}x{}, and a mosaic has at least 2x2 pixels",
                                  light_field_.ImagePath(id).string(), k.width_px, k.height_px));
  const PixelRect inside = Intersection(rect, {0, 0, k.width_px, k.height_px});
  LF_RETURN_IF_ERROR(LoadRecorded(&loading->part, id, MosaicRectOf(inside, k.width_px, k.height_px),
                                  &loading->mosaic));
  Demosaic(loading->mosaic, k.width_px, k.height_px, light_field_.encoding.white_balance, inside,
           pixels);
  return {};
}

Result<void> FolderStore::LoadRecorded(ImagePart* part, LfImageId id, const PixelRect& rect,
                                       LfPixels* pixels) const {
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& intrinsics = light_field_.intrinsics[camera.intrinsics_index];
  const RadianceEncoding& encoding = light_field_.encoding;
  const fs::path path = light_field_.ImagePath(id);
  const PixelRect inside = Intersection(rect, {0, 0, intrinsics.width_px, intrinsics.height_px});
  const PixelRect wanted = inside.empty() ? PixelRect{0, 0, 1, 1} : inside;
  LF_RETURN_IF_ERROR(
      ReadFitting(path, encoding.bayer != BayerPattern::kNone, intrinsics, wanted, part));
  const ChannelUse use = UseOf(part->info);
  LF_RETURN_IF_ERROR(CheckEncoding(*part, encoding, path));

  pixels->Reset(inside, encoding.bayer);
  if (camera.gain == 1)
    ConvertRadiance(*part, use.colours, tables_, encoding, 1, pixels);
  else
    ConvertRadiance(*part, use.colours, RadianceTables(encoding, camera.gain, part->info.bits),
                    encoding, camera.gain, pixels);
  if (use.alpha) MaskTransparent(*part, *use.alpha, pixels);
  if (!light_field_.mask_names.empty() && !light_field_.mask_names[id.value].empty())
    LF_RETURN_IF_ERROR(
        ApplyMaskFile(light_field_.folder / light_field_.mask_names[id.value], intrinsics, pixels));
  return {};
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
