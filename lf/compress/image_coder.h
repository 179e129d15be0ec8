// One LF image into its code, and how far that is from it. Internal to compress.
#pragma once

#include <optional>

#include "lf/capture/radiance.h"
#include "lf/codec/lf_image_codec.h"
#include "lf/compress/code_quality.h"
#include "lf/packed/packed_store_writer.h"
#include "lf/store/display_curve.h"
#include "lf/store/recorded_image.h"

namespace lf {

// Of one light field and some settings, whose threshold counts grey steps.
class ImageCoder {
 public:
  ImageCoder(const RadianceEncoding& encoding, const CodecSettings& settings);

  // The default profile takes linear values of 16 bits along the display curve.
  CodedImage Code(const RecordedImage& image) const;

  // Of the curve, where codes are along one.
  std::optional<DisplayLevels> display_levels() const;

  // Differences are measured in stored values; of linear values of 16 bits, whatever the profile,
  // along the display curve: as they are seen.
  CodeError ErrorOf(const RecordedImage& image, const CodedImage& coded) const;

 private:
  bool IsLinear(const RecordedImage& image) const {
    return curve_ && image.values == StoredValues::kUint16;
  }
  Image<uint16_t> OnCurve(const CodecPixels& pixels) const;

  const RadianceEncoding encoding_;
  const CodecSettings settings_;
  std::optional<DisplayCurve> curve_;
};

}  // namespace lf
