// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/lens_points.h"

#include <algorithm>

#include "lf/core/check.h"

namespace lf {

double LensPointSets::MostSpread() const {
  double most = 1;
  for (const auto& set : spreads)
    for (const double spread : set) most = std::max(most, spread);
  return most;
}

size_t LensPointSets::point_count() const {
  size_t count = 0;
  for (const auto& set : sets) count += set.size();
  return count;
}

LensPointSets MakeLensPoints(const Aperture& aperture, int count, int k, uint64_t seed) {
  LF_CHECK(count >= 1 && k >= 1);
  LensPointSets points;
  if (aperture.radius_w == 0) {
    points.sets = {{Vec2::Zero()}};
    return points;
  }
  points.k = k;
  points.sets.resize(static_cast<size_t>(k) * k);
  // A set has every (k * k)-th point of one sequence, so each set is spread uniformly, and so are
  // all sets together.
  const std::vector<Vec2> all = SampleLens(aperture, count * k * k, seed);
  for (size_t i = 0; i < all.size(); ++i) points.sets[i % points.sets.size()].push_back(all[i]);
  return points;
}

}  // namespace lf
