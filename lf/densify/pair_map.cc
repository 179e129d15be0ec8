// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/pair_map.h"

namespace lf {

PairMap MapBetween(const PinholeCamera& first, const PinholeCamera& second) {
  const RigidTransform second_from_first = second.cam_from_world * first.cam_from_world.Inverse();
  const Mat3 k = second.intrinsics.Matrix();
  const Mat3 far = k * second_from_first.rotation * first.intrinsics.InverseMatrix();
  const Vec3 near = k * second_from_first.translation;
  PairMap map;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      map.a[3 * row + column] = static_cast<float>(far(row, column));
    map.b[row] = static_cast<float>(near[row]);
  }
  return map;
}

double ShiftPerInverseDepth(const PinholeCamera& first, const PinholeCamera& second) {
  const Vec3 offset = first.cam_from_world * second.CentreWorld();
  return first.intrinsics.fx_px * offset.head<2>().norm();
}

}  // namespace lf
