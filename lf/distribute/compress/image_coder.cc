// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/image_coder.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kLargest = 65535;

}  // namespace

ImageCoder::ImageCoder(const RadianceEncoding& encoding, const CodecSettings& settings,
                       KeepFiles files)
    : encoding_(encoding), settings_(settings), files_(files) {
  if (encoding.transfer == Transfer::kLinear && LevelsFit(encoding, 16))
    curve_.emplace(encoding.black_level, encoding.white_level.value_or(kLargest));
}

std::optional<DisplayLevels> ImageCoder::display_levels() const {
  if (!curve_ || settings_.profile != CodecProfile::kDefault) return std::nullopt;
  return DisplayLevels{encoding_.black_level, encoding_.white_level.value_or(kLargest)};
}

Image<uint16_t> ImageCoder::OnCurve(const CodecPixels& pixels) const {
  Image<uint16_t> on_curve = std::get<Image<uint16_t>>(pixels);
  for (uint16_t& value : on_curve.pixels()) value = curve_->OnCurve(value);
  return on_curve;
}

Result<CodedImage> ImageCoder::CodeOrFile(const LightField& light_field, LfImageId id,
                                          const RecordedImage& image, double factor) const {
  if (files_ == KeepFiles::kNone) return Code(image, factor);
  LF_ASSIGN_OR_RETURN(std::optional<CodedImage> file, FileAsCode(light_field, id, image));
  if (file && files_ == KeepFiles::kAll) return *std::move(file);
  return SmallerOf(Code(image, factor), std::move(file));
}

CodedImage ImageCoder::Code(const RecordedImage& image, double factor) const {
  CodecSettings settings = settings_;
  settings.threshold *= factor;
  if (IsLinear(image) && settings.profile == CodecProfile::kDefault) {
    settings.threshold *= curve_->grey_step();
    RecordedImage on_curve = image;
    on_curve.pixels = OnCurve(image.pixels);
    on_curve.values = StoredValues::kDisplay16;
    return CodeOf(on_curve, settings);
  }
  settings.threshold *= GreyStep(encoding_, image.values);
  return CodeOf(image, settings);
}

CodeError ImageCoder::ErrorOf(const RecordedImage& image, const CodedImage& coded) const {
  if (coded.values == StoredValues::kFile)
    return {0, std::visit([](const auto& pixels) { return pixels.pixels().size(); }, image.pixels)};
  DecodedPart decoded;
  const Result<void> result = DecodeImage(coded.code, &decoded);
  LF_CHECK(result.has_value());
  if (!IsLinear(image))
    return lf::ErrorOf(image.pixels, decoded, GreyStep(encoding_, image.values));
  if (coded.values != StoredValues::kDisplay16) decoded.pixels = OnCurve(decoded.pixels);
  return lf::ErrorOf(OnCurve(image.pixels), decoded, curve_->grey_step());
}

}  // namespace lf
