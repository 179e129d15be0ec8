// Rays of one tile of a frame, added up for eight lens points at a time. Internal to rebinning.
#pragma once

#include <array>
#include <span>

#include "lf/core/large_vector.h"
#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/ray_query.h"

namespace lf {

// Lens points side by side in a vector, near each other. A ray is near most of them or none, and
// what it does to an element is one multiplication for all.
struct LensPointGroup {
  static constexpr int kPoints = 8;
  static constexpr float kNowhere = 1e18F;  // of the places that are not used
  std::array<float, kPoints> x;
  std::array<float, kPoints> y;
  std::array<float, kPoints> per_st2;  // 1 / (spread sigma_st)^2
  double reach_w = 0;                  // of the widest
  int count = 0;
  size_t first = 0;  // in the order of the groups
};

// The elements that a tile's sums are of: (x0 + k i, y0 + k j).
struct SplatGrid {
  int x0 = 0;
  int y0 = 0;
  int k = 1;
  int columns = 0;
  int rows = 0;
};

struct SplatSums {
  static constexpr int kChannels = 4;  // R, G, B, and the weight or the number of lens points
  static constexpr int kElement = kChannels * LensPointGroup::kPoints;

  // For one group of lens points  [rows][columns][kChannels][kPoints]
  LargeVector<float> weighted;
  // The means of those that had rays, added up  [rows][columns][kChannels]
  LargeVector<float> means;
  // How much of each lens point of the group counts  [rows][columns][kPoints]  Empty: 1.
  LargeVector<float> shares;

  void Reset(const SplatGrid& grid) {
    const size_t elements = static_cast<size_t>(grid.columns) * grid.rows;
    weighted.assign(elements * kElement, 0.0F);
    means.assign(elements * kChannels, 0.0F);
  }
};

// Wider splats are not known: they would be of more than a few hundred elements.
inline constexpr double kMostSigmaUv_px = 10;

// Adds rays, weighed as ray_query.h says, to the weighted sums.
void AddRays(std::span<const FrameRay> rays, const LensPointGroup& points,
             const QueryKernel& kernel, const SplatGrid& grid, SplatSums* sums);

// Turns the weighted sums into means, adds these, and begins anew.
void AddMeans(const SplatGrid& grid, SplatSums* sums);

}  // namespace lf
