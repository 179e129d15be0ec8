// SPDX-License-Identifier: Apache-2.0
// Encodes one LF image and measures the error. Internal to this folder.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/distribute/compress/code_quality.h"
#include "lf/distribute/compress/keep_files.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/load/display_curve.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

// An encoder for one light field and settings. The threshold of the settings is in grey steps.
// Encoding or measuring a large image takes seconds: functions that return a Result return
// kInterrupted soon after is_interrupted() returns true.
class ImageCoder {
 public:
  //   is_interrupted  called by all threads that call the ImageCoder; may be empty
  ImageCoder(const RadianceEncoding& encoding, const CodecSettings& settings, KeepFiles files,
             std::function<bool()> is_interrupted);

  // Returns the LF image `image` as the store keeps it: encoded, or as its file. kInput: the file
  // cannot be read.
  //   factor  multiplies the threshold of the settings
  Result<CodedImage> CodeOrFile(const LightField& light_field, LfImageId id,
                                const RecordedImage& image, double factor = 1) const;

  // Encodes an image. The default profile encodes linear values of 16 bits along the display curve.
  Result<CodedImage> Code(const RecordedImage& image, double factor = 1) const;

  // Encodes an image relative to others, with `references` as for EncodePredicted().
  Result<CodedImage> CodeFrom(const RecordedImage& image, std::span<const Reference> references,
                              const PredictionSettings& prediction, double factor) const;

  // Returns the values that Code() encodes: along the display curve, or as they are stored.
  RecordedImage Prepared(const RecordedImage& image) const;

  // Returns the levels of the display curve if images are encoded along it.
  std::optional<DisplayLevels> display_levels() const;

  // Measures the error in stored values; none for a file. The error of linear values of 16 bits is
  // measured along the display curve for all profiles, because equal errors along this curve are
  // equally visible.
  Result<CodeError> ErrorOf(const RecordedImage& image, const CodedImage& coded) const;
  // Measures the error of decoded values.
  //   values  CodedImage::values
  CodeError ErrorOf(const RecordedImage& image, StoredValues values,
                    const DecodedPart& decoded) const;

  // Returns the settings of the codec for an image: the threshold in stored values of Prepared().
  CodecSettings SettingsFor(const RecordedImage& image, double factor) const;

 private:
  bool IsEncodedOnCurve(const RecordedImage& image) const {
    return IsLinear(image) && settings_.profile == CodecProfile::kDefault;
  }
  bool IsLinear(const RecordedImage& image) const {
    return curve_ && image.values == StoredValues::kUint16;
  }
  Image<uint16_t> OnCurve(const CodecPixels& pixels) const;
  //   on_curve  OnCurve() of the image if IsLinear()
  CodeError ErrorOf(const RecordedImage& image, const CodecPixels& on_curve, StoredValues values,
                    const DecodedPart& decoded) const;

  const RadianceEncoding encoding_;
  const CodecSettings settings_;
  const KeepFiles files_;
  const std::function<bool()> is_interrupted_;
  std::optional<DisplayCurve> curve_;
};

}  // namespace lf
