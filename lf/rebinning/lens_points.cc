#include "lf/rebinning/lens_points.h"

#include "lf/core/check.h"

namespace lf {

LensPointSets MakeLensPoints(const Aperture& aperture, int count, int k, uint64_t seed) {
  LF_CHECK(count >= 1 && k >= 1);
  LensPointSets points;
  if (aperture.radius_w == 0) {
    points.sets = {{Vec2::Zero()}};
    return points;
  }
  points.k = k;
  points.sets.resize(static_cast<size_t>(k) * k);
  // Every k * k-th of one sequence: each set is spread, and all together are.
  const std::vector<Vec2> all = SampleLens(aperture, count * k * k, seed);
  for (size_t i = 0; i < all.size(); ++i) points.sets[i % points.sets.size()].push_back(all[i]);
  return points;
}

}  // namespace lf
