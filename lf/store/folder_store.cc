#include "lf/store/folder_store.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "lf/capture/image_fit.h"
#include "lf/core/file.h"
#include "lf/imageio/image_file.h"
#include "lf/imageio/upright.h"

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

// The pixels that the calibration is of.
Result<ImageWithInfo> ReadFitting(const fs::path& path, bool is_mosaic,
                                  const Intrinsics& intrinsics) {
  LF_ASSIGN_OR_RETURN(ImageWithInfo read, ReadImageWithInfo(path));
  LF_ASSIGN_OR_RETURN(const ImageFit fit,
                      FitToCalibration(read.info, is_mosaic, intrinsics, path.string()));
  if (fit == ImageFit::kTurned)
    std::visit([&](auto& image) { image = Upright(image, read.info.orientation); }, read.image);
  return read;
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

Result<void> CheckEncoding(const ImageWithInfo& file, const RadianceEncoding& encoding,
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

// Fills radiance from the part `rect` of the stored image; radiance_of(value) is v.
template <class T, class RadianceOf>
void ConvertRadiance(const Image<T>& stored, const ChannelUse& use, const RadianceOf& radiance_of,
                     LfPixels* pixels) {
  const PixelRect& rect = pixels->rect;
  const bool is_mosaic = pixels->bayer != BayerPattern::kNone;
  for (int y = 0; y < rect.height(); ++y) {
    const T* in = stored.row(rect.y_begin + y) + static_cast<size_t>(rect.x_begin) * use.channels;
    uint16_t* out = pixels->radiance.row(y);
    if (is_mosaic) {
      for (int x = 0; x < rect.width(); ++x) *out++ = radiance_of(in[x]);
      continue;
    }
    for (int x = 0; x < rect.width(); ++x, in += use.channels, out += LfPixels::kRgbLanes)
      for (int c = 0; c < 3; ++c) out[c] = radiance_of(in[c < use.colours ? c : 0]);
  }
}

template <class T>
void MaskTransparent(const Image<T>& stored, int alpha, LfPixels* pixels) {
  constexpr double kOpaque = std::is_floating_point_v<T> ? 1 : std::numeric_limits<T>::max();
  const PixelRect& rect = pixels->rect;
  for (int y = 0; y < rect.height(); ++y)
    for (int x = 0; x < rect.width(); ++x)
      if (!(stored.at(rect.x_begin + x, rect.y_begin + y, alpha) >= kOpaque / 2))
        pixels->Mask(x, y);
}

Result<void> ApplyMaskFile(const fs::path& path, const Intrinsics& intrinsics, LfPixels* pixels) {
  LF_ASSIGN_OR_RETURN(const ImageWithInfo mask, ReadFitting(path, false, intrinsics));
  std::visit(
      [&](const auto& stored) {
        const PixelRect& rect = pixels->rect;
        for (int y = 0; y < rect.height(); ++y)
          for (int x = 0; x < rect.width(); ++x)
            if (stored.at(rect.x_begin + x, rect.y_begin + y) == 0) pixels->Mask(x, y);
      },
      mask.image);
  return {};
}

std::vector<uint16_t> TableIfItFits(const RadianceEncoding& encoding, int bits) {
  return LevelsFit(encoding, bits) ? RadianceTable(encoding, bits, 1) : std::vector<uint16_t>();
}

}  // namespace

FolderStore::FolderStore(const LightField& light_field)
    : light_field_(light_field),
      table_8bit_(TableIfItFits(light_field.encoding, 8)),
      table_16bit_(TableIfItFits(light_field.encoding, 16)) {}

void FolderStore::Announce(LfImageId id) const { AnnounceRead(light_field_.ImagePath(id)); }

Result<LfPixels> FolderStore::Load(LfImageId id, const PixelRect& rect) const {
  LF_CHECK(id.value < light_field_.size());
  const LfCamera& camera = light_field_.cameras[id.value];
  const Intrinsics& intrinsics = light_field_.intrinsics[camera.intrinsics_index];
  const RadianceEncoding& encoding = light_field_.encoding;
  const fs::path path = light_field_.ImagePath(id);
  LF_ASSIGN_OR_RETURN(const ImageWithInfo file,
                      ReadFitting(path, encoding.bayer != BayerPattern::kNone, intrinsics));
  const ChannelUse use = UseOf(file.info);
  LF_RETURN_IF_ERROR(CheckEncoding(file, encoding, path));

  LfPixels pixels(Intersection(rect, {0, 0, intrinsics.width_px, intrinsics.height_px}),
                  encoding.bayer);
  const auto convert = [&]<class T>(const Image<T>& stored) {
    if constexpr (std::is_floating_point_v<T>) {
      ConvertRadiance(
          stored, use,
          [&](float radiance) { return QuantizeRadiance(encoding, radiance, camera.gain); },
          &pixels);
    } else {
      constexpr int kBits = 8 * sizeof(T);
      std::vector<uint16_t> own_table;
      if (camera.gain != 1) own_table = RadianceTable(encoding, kBits, camera.gain);
      const std::vector<uint16_t>& shared_table = kBits == 8 ? table_8bit_ : table_16bit_;
      const uint16_t* table = camera.gain != 1 ? own_table.data() : shared_table.data();
      ConvertRadiance(
          stored, use, [table](T value) { return table[value]; }, &pixels);
    }
    if (use.alpha) MaskTransparent(stored, *use.alpha, &pixels);
  };
  std::visit(convert, file.image);
  if (!light_field_.mask_names.empty() && !light_field_.mask_names[id.value].empty())
    LF_RETURN_IF_ERROR(ApplyMaskFile(light_field_.folder / light_field_.mask_names[id.value],
                                     intrinsics, &pixels));
  return pixels;
}

}  // namespace lf
