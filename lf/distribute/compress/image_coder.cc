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
constexpr int kBandRows = 1024;  // rows that are decoded together: those of a tile of the encoder

}  // namespace

ImageCoder::ImageCoder(const RadianceEncoding& encoding, const CodecSettings& settings,
                       KeepFiles files, std::function<bool()> is_interrupted)
    : encoding_(encoding),
      settings_(settings),
      files_(files),
      is_interrupted_(std::move(is_interrupted)) {
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
  LF_ASSIGN_OR_RETURN(std::optional<CodedImage> file,
                      FileAsCode(light_field, id, image, is_interrupted_));
  if (file && files_ == KeepFiles::kAll) return *std::move(file);
  LF_ASSIGN_OR_RETURN(CodedImage code, Code(image, factor));
  return SmallerOf(std::move(code), std::move(file));
}

CodecSettings ImageCoder::SettingsFor(const RecordedImage& image, double factor) const {
  CodecSettings settings = settings_;
  settings.threshold *=
      factor * (IsEncodedOnCurve(image) ? curve_->grey_step() : GreyStep(encoding_, image.values));
  return settings;
}

RecordedImage ImageCoder::Prepared(const RecordedImage& image) const {
  RecordedImage prepared = image;
  if (!IsEncodedOnCurve(image)) return prepared;
  prepared.pixels = OnCurve(image.pixels);
  prepared.values = StoredValues::kDisplay16;
  return prepared;
}

Result<CodedImage> ImageCoder::Code(const RecordedImage& image, double factor) const {
  const CodecSettings settings = SettingsFor(image, factor);
  if (!IsEncodedOnCurve(image)) return CodeOf(image, settings, is_interrupted_);
  return CodeOf(Prepared(image), settings, is_interrupted_);
}

Result<CodedImage> ImageCoder::CodeFrom(const RecordedImage& image,
                                        std::span<const Reference> references,
                                        const PredictionSettings& prediction, double factor) const {
  const CodecSettings settings = SettingsFor(image, factor);
  if (!IsEncodedOnCurve(image))
    return lf::CodeFrom(image, settings, references, prediction, is_interrupted_);
  return lf::CodeFrom(Prepared(image), settings, references, prediction, is_interrupted_);
}

Result<CodeError> ImageCoder::ErrorOf(const RecordedImage& image, const CodedImage& coded) const {
  if (coded.values == StoredValues::kFile)
    return CodeError{
        0, std::visit([](const auto& pixels) { return pixels.pixels().size(); }, image.pixels)};
  const CodecPixels on_curve = IsLinear(image) ? OnCurve(image.pixels) : CodecPixels();
  CodeError error;
  DecodedPart decoded;
  for (int y = 0; y < image.rect.height(); y += kBandRows) {
    if (is_interrupted_ && is_interrupted_()) return Error{ErrorKind::kInterrupted, "interrupted"};
    const PixelRect band = {0, y, image.rect.width(), std::min(y + kBandRows, image.rect.height())};
    const Result<void> result = DecodeImage(coded.code, band, &decoded);
    LF_CHECK(result.has_value() && decoded.rect == band);
    error += ErrorOf(image, on_curve, coded.values, decoded);
  }
  return error;
}

CodeError ImageCoder::ErrorOf(const RecordedImage& image, StoredValues values,
                              const DecodedPart& decoded) const {
  return ErrorOf(image, IsLinear(image) ? OnCurve(image.pixels) : CodecPixels(), values, decoded);
}

CodeError ImageCoder::ErrorOf(const RecordedImage& image, const CodecPixels& on_curve,
                              StoredValues values, const DecodedPart& decoded) const {
  if (!IsLinear(image))
    return lf::ErrorOf(image.pixels, decoded, GreyStep(encoding_, image.values));
  if (values == StoredValues::kDisplay16)
    return lf::ErrorOf(on_curve, decoded, curve_->grey_step());
  return lf::ErrorOf(on_curve, {OnCurve(decoded.pixels), decoded.rect}, curve_->grey_step());
}

}  // namespace lf
