// SPDX-License-Identifier: Apache-2.0
// The points of the lens through which a frame queries rays (thesis 4.3.3, Eq. 4.7).
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"

namespace lf {

// Lens points in k * k sets: element (x, y) uses set (y % k) * k + x % k. Several sets turn the
// steps that one set would make in large blurs into noise.
struct LensPointSets {
  int k = 1;
  std::vector<std::vector<Vec2>> sets;  // [k * k][points of the set], lens coordinates, world units
  // Factor of QueryKernel::sigma_st_w for each point, at least 1; larger if rays near the point are
  // rare. Has the shape of `sets`; empty: all factors are 1.
  std::vector<std::vector<double>> spreads = {};

  double SpreadOf(size_t set, size_t point) const {
    return spreads.empty() ? 1 : spreads[set][point];
  }
  double MostSpread() const;
  size_t point_count() const;  // number of points in all sets together
};
// Returns `count` points in each of k * k sets, spread uniformly over the opening, all different
// (camera/aperture.h, SampleLens). A pinhole has one point in one set.
LensPointSets MakeLensPoints(const Aperture& aperture, int count, int k, uint64_t seed);

}  // namespace lf
