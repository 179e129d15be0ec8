// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lf {
namespace {

constexpr int kDirections[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                   {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

int DifferenceOf(const uint16_t* a, const uint16_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

Image<uint8_t> CountAgreeing(const DepthPlane& plane, const Image<uint16_t>& tones,
                             std::span<const DepthView> views, const InverseDepths& range,
                             double tolerance, InterruptFlag interrupted) {
  Image<uint8_t> agreeing(plane.width(), plane.height());
  for (int y = 0; y < plane.height() && !IsSet(interrupted); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      if (IsTransparent(&tones.at(x, y))) continue;
      const auto z = static_cast<float>(range.Of(plane.at(x, y)));
      for (const DepthView& view : views) {
        const PairMap::Place place =
            view.from_reference.At(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z);
        if (!(place.w > 0 && place.u_px >= 0 && place.v_px >= 0 &&
              place.u_px < static_cast<float>(view.plane->width()) &&
              place.v_px < static_cast<float>(view.plane->height())))
          continue;
        const uint16_t there =
            view.plane->at(static_cast<int>(place.u_px), static_cast<int>(place.v_px));
        if (there == InverseDepths::kUnknown) continue;
        if (std::abs(range.Of(there) - static_cast<double>(z / place.w)) <= tolerance)
          ++agreeing.at(x, y);
      }
    }
  return agreeing;
}

DepthPlane FillDisagreeing(const DepthPlane& plane, const Image<uint8_t>& agreeing, int wanted,
                           const Image<uint16_t>& tones, const InverseDepths& range,
                           double shift_per_depth_px, InterruptFlag interrupted) {
  constexpr int kReach = 60;
  // Cost of a neighbouring depth, in tones, per pixel of shift and per pixel of distance.
  constexpr float kPerShift = 2, kPerDistance = 0.5f;
  // Limit of the cost of the nearest depth. Without it, tones could not outweigh depths if LF
  // cameras are far apart.
  constexpr double kMostForDepth = 20;
  const auto per_number = static_cast<float>(std::min(kPerShift * shift_per_depth_px * range.Step(),
                                                      kMostForDepth / InverseDepths::kLast));
  DepthPlane filled = plane;
  for (int y = 0; y < plane.height() && !IsSet(interrupted); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      if (agreeing.at(x, y) >= wanted) continue;
      float best = INFINITY;
      for (const auto& [dx, dy] : kDirections)
        for (int step = 1, i = x + dx, j = y + dy;
             step < kReach && i >= 0 && j >= 0 && i < plane.width() && j < plane.height();
             ++step, i += dx, j += dy) {
          if (agreeing.at(i, j) < wanted) continue;
          const float cost = static_cast<float>(DifferenceOf(&tones.at(x, y), &tones.at(i, j))) +
                             per_number * static_cast<float>(plane.at(i, j)) +
                             kPerDistance * static_cast<float>(step);
          if (cost < best) {
            best = cost;
            filled.at(x, y) = plane.at(i, j);
          }
          break;
        }
    }
  return filled;
}

}  // namespace lf
