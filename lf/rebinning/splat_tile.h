// SPDX-License-Identifier: Apache-2.0
// Sums of the rays of one tile of a frame, for eight lens points at a time. Internal to rebinning.
#pragma once

#include <array>
#include <span>

#include "lf/core/large_vector.h"
#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/ray_query.h"

namespace lf {

// Lens points near each other, in the lanes of a vector. A ray is near most of them or none, and
// one vector multiplication computes its weights at an element for all of them.
struct LensPointGroup {
  static constexpr int kPoints = 8;
  static constexpr float kNowhere = 1e18F;  // coordinates of unused lanes
  std::array<float, kPoints> x;
  std::array<float, kPoints> y;
  std::array<float, kPoints> per_st2;  // 1 / (spread * sigma_st)^2 of each point
  double reach_w = 0;                  // largest reach of the points
  int count = 0;
  size_t first = 0;  // index of the group's first point in GroupedSet::points (splat.cc)
};

// The elements (x0 + k * column, y0 + k * row) of a tile, which use the same set of lens points; k
// as in LensPointSets.
struct SplatGrid {
  int x0 = 0;
  int y0 = 0;
  int k = 1;
  int columns = 0;
  int rows = 0;
};

struct SplatSums {
  static constexpr int kChannels = 4;  // R, G, B, and the weight (in `means` the sum of shares)
  static constexpr int kElement = kChannels * LensPointGroup::kPoints;

  // Weighted sums of one group of lens points  [rows][columns][kChannels][kPoints]
  LargeVector<float> weighted;
  // Sums of the means of the lens points that had rays, times their shares
  // [rows][columns][kChannels]
  LargeVector<float> means;
  // Weight of each lens point of the group  [rows][columns][kPoints]; empty: all 1
  LargeVector<float> shares;

  void Reset(const SplatGrid& grid) {
    const size_t elements = static_cast<size_t>(grid.columns) * grid.rows;
    weighted.assign(elements * kElement, 0.0F);
    means.assign(elements * kChannels, 0.0F);
  }
};

// Largest supported sigma_uv: the splat of a ray then covers about 2800 elements.
inline constexpr double kMostSigmaUv_px = 10;

// Adds rays, with the weights of ray_query.h, to the weighted sums.
void AddRays(std::span<const FrameRay> rays, const LensPointGroup& points,
             const QueryKernel& kernel, const SplatGrid& grid, SplatSums* sums);

// For each lens point of the group, adds the mean of its weighted sums, times its share, to
// `means`. Resets the weighted sums to 0.
void AddMeans(const SplatGrid& grid, SplatSums* sums);

}  // namespace lf
