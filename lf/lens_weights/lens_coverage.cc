#include "lf/lens_weights/lens_coverage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/lens_weights/point_grid.h"

namespace lf {

double UncoveredShare(std::span<const Vec2> points, const Aperture& aperture) {
  constexpr int kSamples = 256;
  const PointGrid grid(points);
  std::vector<double> distances;
  for (const Vec2& point : points) {
    const double distance = grid.DistanceToNearest(point, true);
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  if (distances.empty()) return 1;
  const auto middle = distances.begin() + static_cast<ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double far = kFarDistances * *middle;
  const std::vector<Vec2> places = SampleLens(aperture, aperture.radius_w > 0 ? kSamples : 1);
  const auto uncovered = std::count_if(places.begin(), places.end(), [&](const Vec2& place) {
    return grid.DistanceToNearest(place) > far;
  });
  return static_cast<double>(uncovered) / static_cast<double>(places.size());
}

}  // namespace lf
