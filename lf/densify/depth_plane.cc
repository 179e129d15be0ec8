// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "lf/densify/semi_global.h"

namespace lf {
namespace {

constexpr int kTile = 384;   // pixels along the side of a tile
constexpr int kMargin = 48;  // pixels around a tile that are matched with it

std::vector<PixelRect> TilesOf(int width, int height) {
  const auto cut = [](int size) { return std::max(1, (size + kTile / 2) / kTile); };
  const int columns = cut(width), rows = cut(height);
  std::vector<PixelRect> tiles;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      tiles.push_back({width * column / columns, height * row / rows,
                       width * (column + 1) / columns, height * (row + 1) / rows});
  return tiles;
}

DepthPlane MedianOfNine(const DepthPlane& plane, InterruptFlag interrupted) {
  DepthPlane smooth(plane.width(), plane.height());
  const int last_x = plane.width() - 1, last_y = plane.height() - 1;
  for (int y = 0; y <= last_y && !IsSet(interrupted); ++y)
    for (int x = 0; x <= last_x; ++x) {
      std::array<uint16_t, 9> values;
      size_t count = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          values[count++] = plane.at(std::clamp(x + i, 0, last_x), std::clamp(y + j, 0, last_y));
      std::nth_element(values.begin(), values.begin() + 4, values.end());
      smooth.at(x, y) = values[4];
    }
  return smooth;
}

constexpr int kDirections[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                   {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

int DifferenceOf(const uint16_t* a, const uint16_t* b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

DepthPlane SweepDepths(const WorkingImage& reference, std::span<const SweepView> views,
                       const InverseDepths& range, int planes, InterruptFlag interrupted) {
  const int width = reference.width(), height = reference.height();
  DepthPlane plane(width, height);
  const std::vector<PixelRect> tiles = TilesOf(width, height);
  const float scale = static_cast<float>(InverseDepths::kLast / (planes - 1));
  for (const PixelRect& tile : tiles) {
    if (IsSet(interrupted)) return plane;
    const PixelRect around = Intersection({tile.x_begin - kMargin, tile.y_begin - kMargin,
                                           tile.x_end + kMargin, tile.y_end + kMargin},
                                          {0, 0, width, height});
    MatchingCosts costs;
    ComputeMatchingCosts(reference, views, range, planes, around, &costs, interrupted);
    const ChosenPlanes chosen = ChoosePlanes(costs, reference.tones, false, interrupted);
    for (int y = tile.y_begin; y < tile.y_end; ++y)
      for (int x = tile.x_begin; x < tile.x_end; ++x) {
        const float place = chosen.place.at(x - around.x_begin, y - around.y_begin);
        plane.at(x, y) = static_cast<uint16_t>(1.5f + place * scale);
      }
  }
  return MedianOfNine(plane, interrupted);
}

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
  // Limit of that of the nearest depth. Where LF cameras are far apart, tones could not outweigh
  // it.
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
