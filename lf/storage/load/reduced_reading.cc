// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/reduced_reading.h"

#include "lf/camera/resolution.h"
#include "lf/light_field/model/channel_use.h"
#include "lf/light_field/model/image_fit.h"
#include "lf/storage/load/image_reading.h"

namespace lf {

Result<int> LoadReducedFile(
    const std::function<Result<int>(const WantedReduction& wanted, ImagePart* part)>& read,
    const std::string& name, const LightField& light_field, LfImageId id, int divisor,
    const RadianceTables& tables, ImagePart* part, LfPixels* pixels) {
  const RadianceEncoding& encoding = light_field.encoding;
  const LfCamera& camera = light_field.cameras[id.value];
  if (divisor % 2 != 0 || encoding.masks_clipped || encoding.HasOpacity() ||
      encoding.bayer != BayerPattern::kNone)
    return 1;
  const Intrinsics& k = light_field.intrinsics[camera.intrinsics_index];
  const auto wanted = [&](const ImageFileInfo& info) -> Result<int> {
    LF_ASSIGN_OR_RETURN(const ImageFit fit, FitToCalibration(info, false, k, name));
    if (fit == ImageFit::kTurned) return 1;
    return divisor % 8 == 0 ? 8 : divisor % 4 == 0 ? 4 : 2;
  };
  LF_ASSIGN_OR_RETURN(const int reduction, read(wanted, part));
  if (reduction == 1) return 1;
  LF_RETURN_IF_ERROR(CheckLevels(encoding, part->info.bits, name));
  ConvertColours(encoding, part);
  const Intrinsics reduced = WithLargerPixels(k, reduction);
  pixels->Reset({0, 0, reduced.width_px, reduced.height_px}, BayerPattern::kNone);
  ConvertRadiance(*part, UseOf(part->info).colours, tables, encoding, camera, reduced, pixels);
  return reduction;
}

}  // namespace lf
