// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/stored_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"

namespace lf {

DepthPlane PaddedTo(const DepthPlane& plane, PlaneSize size) {
  DepthPlane padded(size.width, size.height);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      padded.at(x, y) = plane.at(std::min(x, plane.width() - 1), std::min(y, plane.height() - 1));
  return padded;
}

DepthPlane CutTo(const DepthPlane& plane, int width, int height) {
  DepthPlane cut(width, height);
  for (int y = 0; y < height; ++y) std::copy_n(plane.row(y), width, cut.row(y));
  return cut;
}

DepthPlane AsRecorded(const DepthPlane& plane, const Intrinsics& k, int divisor,
                      InterruptFlag interrupted) {
  DepthPlane recorded = PaddedTo(plane, PlaneSizeOf(k.width_px, k.height_px, divisor));
  if (!k.has_distortion()) return recorded;
  const DistortionMap map(k.distortion);
  for (int y = 0; y < recorded.height() && !IsSet(interrupted); ++y)
    for (int x = 0; x < recorded.width(); ++x) {
      const std::optional<Vec3> ideal =
          IdealPosition(k, map, (x + 0.5) * divisor, (y + 0.5) * divisor);
      const double column = ideal ? std::floor(ideal->x() / ideal->z() / divisor) : -1;
      const double row = ideal ? std::floor(ideal->y() / ideal->z() / divisor) : -1;
      const bool is_there = ideal && ideal->z() > 0 && column >= 0 && row >= 0 &&
                            column < plane.width() && row < plane.height();
      recorded.at(x, y) =
          is_there ? plane.at(static_cast<int>(column), static_cast<int>(row)) : uint16_t{0};
    }
  return recorded;
}

}  // namespace lf
