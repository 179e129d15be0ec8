// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/distortion_name.h"

#include "lf/core/check.h"

namespace lf {

const char* NameOf(DistortionModel model) {
  switch (model) {
    case DistortionModel::kNone:
      return "pinhole";
    case DistortionModel::kRadialTangential:
      return "radial-tangential";
    case DistortionModel::kFisheye:
      return "fisheye";
    case DistortionModel::kFov:
      return "fov";
    case DistortionModel::kDivision:
      return "division";
    case DistortionModel::kUnified:
      return "unified";
    case DistortionModel::kThinPrism:
      return "thin-prism fisheye";
    case DistortionModel::kRadialTangentialThinPrism:
      return "radial-tangential thin-prism fisheye";
    case DistortionModel::kBrown:
      return "brown";
  }
  LF_CHECK(false);
}

}  // namespace lf
