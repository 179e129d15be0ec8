// SPDX-License-Identifier: Apache-2.0
// The curve through the keyframes of a camera path of instant-ngp, as that program computes it.
// Internal to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace lf {

// Numbers of a keyframe: quaternion x y z w, position x y z, slice, scale, fov, aperture_size.
inline constexpr int kNgpNumbers = 11;
using NgpNumbers = Eigen::Matrix<double, kNgpNumbers, 1>;

struct NgpCurve {
  std::vector<NgpNumbers> keys;    // at least one
  std::vector<double> timestamps;  // of the ends of the segments that begin at the keys
  int spline_order = 3;            // 0 to 3
  bool loop = false;
};

// Replaces the timestamps by equidistant ones unless they increase from above 0. Both programs do
// so with files of older versions, which have none.
void RepairTimestamps(NgpCurve* curve);

// Returns the camera at a share t, from 0 to below 1, of the duration. Its quaternion has length 1.
// Orders 2 and 3 are B-splines, which do not pass through the keys.
//   timestamps  must have been repaired
NgpNumbers At(const NgpCurve& curve, double t);

}  // namespace lf
