// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/recorded_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>
#include <variant>

#include "lf/camera/vignetting.h"
#include "lf/core/file.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/picture_view.h"
#include "lf/storage/load/demosaic.h"
#include "lf/storage/load/image_reading.h"
#include "lf/storage/load/opacities.h"
#include "lf/storage/load/ordered_half.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

PixelRect WholeOf(const LightField& light_field, LfImageId id) {
  const Intrinsics& k = light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
  return {0, 0, k.width_px, k.height_px};
}

// Returns the first `channels` channels of the pixels `rect`. convert() converts each value.
template <class To, class From, class Convert>
Image<To> Cut(const Image<From>& stored, const PixelRect& stored_rect, const PixelRect& rect,
              int channels, const Convert& convert) {
  Image<To> cut(rect.width(), rect.height(), channels);
  const int stored_channels = stored.channels();
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const From* in = stored.row(y - stored_rect.y_begin) +
                     static_cast<size_t>(rect.x_begin - stored_rect.x_begin) * stored_channels;
    To* out = cut.row(y - rect.y_begin);
    for (int x = rect.x_begin; x < rect.x_end; ++x, in += stored_channels, out += channels)
      for (int c = 0; c < channels; ++c) out[c] = convert(in[c]);
  }
  return cut;
}

// Sets the values and pixels of `image`. Returns the largest finite value of floats; 0 if none is
// above 0.
float CutStored(const ImagePart& part, int channels, RecordedImage* image) {
  float largest = 0;
  if (const auto* bytes = std::get_if<Image<uint8_t>>(&part.image)) {
    image->values = StoredValues::kUint8;
    image->pixels =
        Cut<uint8_t>(*bytes, part.rect, image->rect, channels, [](uint8_t value) { return value; });
  } else if (const auto* words = std::get_if<Image<uint16_t>>(&part.image)) {
    image->values = StoredValues::kUint16;
    image->pixels = Cut<uint16_t>(*words, part.rect, image->rect, channels,
                                  [](uint16_t value) { return value; });
  } else {
    image->values = StoredValues::kHalf;
    image->pixels =
        Cut<uint16_t>(std::get<Image<float>>(part.image), part.rect, image->rect, channels,
                      [image, &largest](float value) {
                        const uint16_t ordered = OrderedOfFloat(value);
                        if (value > largest && std::isfinite(value)) largest = value;
                        // The condition is false for NaN, because turning NaN into 0 does not count
                        // as rounding.
                        if (FloatOfOrdered(ordered) < value || FloatOfOrdered(ordered) > value)
                          image->is_rounded = true;
                        return ordered;
                      });
  }
  return largest;
}

Result<RecordedImage> ReadMaskAsOpacities(const LightField& light_field, LfImageId id,
                                          const ImagePart& part, const ChannelUse& use,
                                          RecordedImage image) {
  const PixelRect& rect = image.rect;
  LF_RETURN_IF_ERROR(ForEachMasked(light_field, id, part, use, rect, [&](int x, int y) {
    if (image.opacities.empty())
      image.opacities = Image<uint16_t>(rect.width(), rect.height(), 1, kOpaqueOpacity);
    image.opacities.at(x - rect.x_begin, y - rect.y_begin) = kMaskedOpacity;
  }));
  return image;
}

// Returns kInput if half floats would change the light of a float file by more than their rounding:
// if light below max_radiance would become infinite, or if gains make the steps of the smallest
// half floats larger than those of 16-bit radiance.
//   largest  the largest value that is finite
Result<void> CheckHalfHolds(const LightField& light_field, LfImageId id, float largest) {
  constexpr double kMost = 65520, kLeastStep = 0x1p-24;
  const LfCamera& camera = light_field.cameras[id.value];
  const RadianceEncoding& encoding = light_field.encoding;
  const FalloffRange falloff = FalloffRangeOf(light_field.intrinsics[camera.intrinsics_index]);
  const auto [least, most] =
      std::minmax_element(camera.gain.of_channels.begin(), camera.gain.of_channels.end());
  const double dimmest = *least / falloff.max, brightest = *most / falloff.min;
  if (largest >= kMost && kMost * dimmest < encoding.max_radiance)
    return InputError(fmt::format(
        "{}: has the value {:.6g}, but packed stores hold floats up to {}: divide the values of "
        "all images by a number, and multiply lf_gain by it; or use the folder without a store",
        light_field.ImagePath(id).string(), largest, kMost));
  if (kLeastStep * brightest > 1 / encoding.Scale())
    return InputError(fmt::format(
        "{}: lf_gain multiplies its values by up to {:.6g}, which makes the smallest steps of the "
        "half floats of packed stores visible: multiply the values of all images by a number, and "
        "divide lf_gain by it; or use the folder without a store",
        light_field.ImagePath(id).string(), brightest));
  return {};
}

uint64_t SizeOf(const fs::path& path) {
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  return error ? 0 : size;
}

// Returns everything of an encoded image but the pixels. kInterrupted as CodeOf().
Result<CodedImage> MaskOf(const RecordedImage& image, const std::function<bool()>& is_interrupted) {
  CodedImage coded;
  coded.values = image.values;
  coded.rect = image.rect;
  CodecSettings settings;
  settings.profile = CodecProfile::kLossless;
  if (!image.mask.empty()) {
    LF_ASSIGN_OR_RETURN(coded.mask,
                        EncodeImage(image.mask, PixelLayout::kGrey, settings, is_interrupted));
  }
  if (!image.opacities.empty()) {
    LF_ASSIGN_OR_RETURN(coded.mask,
                        EncodeImage(image.opacities, PixelLayout::kGrey, settings, is_interrupted));
  }
  coded.source_bytes = image.source_bytes;
  return coded;
}

}  // namespace

Result<RecordedImage> ReadRecordedImage(const LightField& light_field, LfImageId id,
                                        const PixelRect& rect) {
  LF_CHECK(id.value < light_field.size());
  const fs::path path = light_field.ImagePath(id);
  RecordedImage image;
  image.rect = Intersection(rect, WholeOf(light_field, id));
  if (image.rect.empty())
    return InputError(fmt::format(
        "{}: none of the requested pixels, [{}, {}) in x and [{}, {}) in y, lie in this image",
        path.string(), rect.x_begin, rect.x_end, rect.y_begin, rect.y_end));
  ImagePart part;
  LF_ASSIGN_OR_RETURN(const ChannelUse use, ReadStoredPixels(light_field, id, image.rect, &part));
  const float largest = CutStored(part, use.colours, &image);
  if (image.values == StoredValues::kHalf)
    LF_RETURN_IF_ERROR(CheckHalfHolds(light_field, id, largest));
  image.layout = light_field.encoding.bayer != BayerPattern::kNone ? PixelLayout::kMosaic
                 : use.colours == 3                                ? PixelLayout::kRgb
                                                                   : PixelLayout::kGrey;
  image.source_bytes = SourceBytesOf(light_field, id);
  if (use.alpha && light_field.encoding.AlphaIsLight()) {
    LF_ASSIGN_OR_RETURN(image.opacities, ReadOpacities(light_field, id, part, use, image.rect));
    const std::span<const uint16_t> all = image.opacities.pixels();
    if (std::all_of(all.begin(), all.end(), [](uint16_t o) { return o > kMostOpacity; }))
      image.opacities = {};
    return image;
  }
  // If alpha is light in this light field, an LF image without alpha is opaque except where its
  // mask file or a bracket masks it.
  if (light_field.encoding.AlphaIsLight() && image.layout != PixelLayout::kMosaic)
    return ReadMaskAsOpacities(light_field, id, part, use, std::move(image));
  LF_RETURN_IF_ERROR(ForEachMasked(light_field, id, part, use, image.rect, [&image](int x, int y) {
    if (image.mask.empty())
      image.mask = Image<uint8_t>(image.rect.width(), image.rect.height(), 1, 255);
    image.mask.at(x - image.rect.x_begin, y - image.rect.y_begin) = 0;
  }));
  return image;
}

PixelRect RectToRecord(const LightField& light_field, LfImageId id, const PixelRect& rect) {
  const PixelRect whole = WholeOf(light_field, id);
  const PixelRect inside = Intersection(rect, whole);
  if (inside.empty() || light_field.encoding.bayer == BayerPattern::kNone) return inside;
  return MosaicRectOf(inside, whole.width(), whole.height());
}

bool CanKeepFile(const LightField& light_field, LfImageId id, const PixelRect& rect) {
  return rect == WholeOf(light_field, id) && !PictureViewOf(light_field.ImagePath(id));
}

Result<std::optional<CodedImage>> FileAsCode(const LightField& light_field, LfImageId id,
                                             const RecordedImage& image,
                                             const std::function<bool()>& is_interrupted) {
  if (!CanKeepFile(light_field, id, image.rect)) return std::optional<CodedImage>();
  LF_ASSIGN_OR_RETURN(CodedImage coded, MaskOf(image, is_interrupted));
  coded.values = StoredValues::kFile;
  LF_ASSIGN_OR_RETURN(coded.code, ReadFile(light_field.ImagePath(id)));
  return std::optional(std::move(coded));
}

CodedImage SmallerOf(CodedImage code, std::optional<CodedImage> file) {
  return file && file->code.size() <= code.code.size() ? *std::move(file) : std::move(code);
}

CodedImage CodeOf(const RecordedImage& image, const CodecSettings& settings) {
  return *CodeOf(image, settings, {});
}

Result<CodedImage> CodeOf(const RecordedImage& image, const CodecSettings& settings,
                          const std::function<bool()>& is_interrupted) {
  LF_ASSIGN_OR_RETURN(CodedImage coded, MaskOf(image, is_interrupted));
  LF_ASSIGN_OR_RETURN(coded.code,
                      EncodeImage(image.pixels, image.layout, settings, is_interrupted));
  if (coded.mask.empty()) coded.front_ends = *FrontEndsOf(coded.code);
  return coded;
}

Result<CodedImage> CodeFrom(const RecordedImage& image, const CodecSettings& settings,
                            std::span<const Reference> references,
                            const PredictionSettings& prediction,
                            const std::function<bool()>& is_interrupted) {
  LF_ASSIGN_OR_RETURN(CodedImage coded, MaskOf(image, is_interrupted));
  coded.code = EncodePredicted(image.pixels, image.layout, settings, references, prediction);
  if (is_interrupted && is_interrupted()) return Error{ErrorKind::kInterrupted, "interrupted"};
  return coded;
}

Result<std::vector<uint64_t>> FrontEndsOf(std::string_view code) {
  LF_ASSIGN_OR_RETURN(std::vector<uint64_t> ends, ResolutionEnds(code));
  ends.pop_back();
  return ends;
}

uint64_t SourceBytesOf(const LightField& light_field, LfImageId id) {
  uint64_t bytes = SizeOf(ImageFileOf(light_field, id));
  if (bytes > 0 && !light_field.mask_names.empty() && !light_field.mask_names[id.value].empty())
    bytes += SizeOf(light_field.folder / light_field.mask_names[id.value]);
  return bytes;
}

}  // namespace lf
