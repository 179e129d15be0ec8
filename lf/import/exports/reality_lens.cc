// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/reality_lens.h"

#include "lf/import/exports/export_cameras.h"

namespace lf {

Distortion RealityDistortion(const RealityCoefficients& coefficients) {
  const auto& [k1, k2, k3, k4, t1, t2] = coefficients;
  if (k4 != 0) return {DistortionModel::kBrown, {k1, k2, t2, t1, k3, k4}};
  return DistortionOf(DistortionModel::kRadialTangential, {k1, k2, t2, t1, k3});
}

Mat3 RealityRotation(double yaw_deg, double pitch_deg, double roll_deg) {
  Mat3 enu_from_ned, body_from_cam;
  enu_from_ned << 0, 1, 0,  // east
      1, 0, 0,              // north
      0, 0, -1;             // up
  // The image's right side points to the right wing, and its lower side to the tail.
  body_from_cam << 0, -1, 0,  // nose
      1, 0, 0,                // right wing
      0, 0, 1;                // down
  const Mat3 ned_from_body = (Eigen::AngleAxisd(RadiansFromDegrees(yaw_deg), Vec3::UnitZ()) *
                              Eigen::AngleAxisd(RadiansFromDegrees(pitch_deg), Vec3::UnitY()) *
                              Eigen::AngleAxisd(RadiansFromDegrees(roll_deg), Vec3::UnitX()))
                                 .toRotationMatrix();
  return (enu_from_ned * ned_from_body * body_from_cam).transpose();
}

}  // namespace lf
