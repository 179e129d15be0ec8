// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/recorded_codes.h"

#include <optional>
#include <utility>

#include "lf/light_field/model/channel_use.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

Result<StoredKind> KindOfCode(const CodedImage& image, const RadianceEncoding& encoding) {
  if (image.values == StoredValues::kFile) {
    LF_ASSIGN_OR_RETURN(const ImageFileInfo file, ReadImageInfoBytes(image.code, "image file"));
    return StoredKind{file.is_float    ? StoredValues::kHalf
                      : file.bits == 8 ? StoredValues::kUint8
                                       : StoredValues::kUint16,
                      encoding.bayer != BayerPattern::kNone ? PixelLayout::kMosaic
                      : UseOf(file).colours == 3            ? PixelLayout::kRgb
                                                            : PixelLayout::kGrey};
  }
  LF_ASSIGN_OR_RETURN(const CodeInfo info, ReadCodeInfo(image.code));
  const bool is_on_curve = image.values == StoredValues::kDisplay16;
  return StoredKind{is_on_curve ? StoredValues::kUint16 : image.values, info.layout};
}

Result<std::unique_ptr<RecordedCodes>> RecordedCodes::Open(const LightField& light_field) {
  std::unique_ptr<RecordedCodes> recorded(new RecordedCodes(light_field));
  if (!HoldsPackedStore(light_field)) return recorded;
  LF_ASSIGN_OR_RETURN(recorded->copied_, CopiedCodes::Open(light_field));
  return recorded;
}

Result<CodedImage> RecordedCodes::Of(LfImageId id,
                                     const std::function<bool()>& is_interrupted) const {
  if (!copied_) {
    const Intrinsics& k = light_field_.Camera(id).intrinsics;
    LF_ASSIGN_OR_RETURN(const RecordedImage image,
                        ReadRecordedImage(light_field_, id, {0, 0, k.width_px, k.height_px}));
    CodecSettings settings;
    settings.profile = CodecProfile::kLossless;
    LF_ASSIGN_OR_RETURN(std::optional<CodedImage> file,
                        FileAsCode(light_field_, id, image, is_interrupted));
    LF_ASSIGN_OR_RETURN(CodedImage code, CodeOf(image, settings, is_interrupted));
    return SmallerOf(std::move(code), std::move(file));
  }
  return copied_->Of(id);
}

void RecordedCodes::Describe(PackedStorePlan* plan) const {
  if (copied_)
    copied_->Describe(plan);
  else
    plan->codec = kLosslessCodec;
}

Result<StoredKind> RecordedCodes::KindOf(LfImageId id) const {
  if (!copied_) {
    LF_ASSIGN_OR_RETURN(const RecordedImage image,
                        ReadRecordedImage(light_field_, id, {0, 0, 2, 2}));
    return StoredKind{image.values, image.layout};
  }
  LF_ASSIGN_OR_RETURN(const CodedImage image, Of(id));
  return KindOfCode(image, light_field_.encoding);
}

}  // namespace lf
