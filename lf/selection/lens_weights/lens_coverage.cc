// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/lens_coverage.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <vector>

#include "lf/selection/lens_weights/covered_region.h"
#include "lf/selection/lens_weights/point_grid.h"

namespace lf {
namespace {

// Returns one point of each group of points that are close together compared with `distance`. A
// camera on a tripod, for example, is recorded many times at slightly different positions.
std::vector<Vec2> OneOfEachPlace(std::span<const Vec2> points, double distance) {
  constexpr double kSamePlace = 1.0 / 16;
  struct Placed {
    int64_t x, y;
    size_t point;
    auto operator<=>(const Placed&) const = default;
  };
  std::vector<Placed> placed;
  placed.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec2 place = points[i] / (kSamePlace * distance);
    placed.push_back({std::llround(place.x()), std::llround(place.y()), i});
  }
  std::sort(placed.begin(), placed.end());
  std::vector<Vec2> kept;
  for (size_t k = 0; k < placed.size(); ++k)
    if (k == 0 || placed[k].x != placed[k - 1].x || placed[k].y != placed[k - 1].y)
      kept.push_back(points[placed[k].point]);
  return kept;
}

// Returns the median of the distances to the nearest neighbours, weighted by their squares, so that
// cameras that crowd in a corner do not decide. 0 if there are fewer than two points.
double DistanceOfDistinct(const std::vector<Vec2>& points) {
  const PointGrid grid(points);
  std::vector<double> distances;
  double area = 0;
  for (const Vec2& point : points) {
    const double distance = grid.DistanceToNearest(point, true);
    if (!std::isfinite(distance)) continue;
    distances.push_back(distance);
    area += distance * distance;
  }
  std::sort(distances.begin(), distances.end());
  double sum = 0;
  for (const double distance : distances)
    if ((sum += distance * distance) >= 0.5 * area) return distance;
  return 0;
}

}  // namespace

double DistanceOfMost(std::span<const Vec2> points) {
  if (points.empty()) return 0;
  return DistanceOfDistinct(OneOfEachPlace(points, PointGrid(points).bucket_size()));
}

CoveredRegion CoveredBy(std::span<const Vec2> points) {
  const double distance = DistanceOfMost(points);
  return distance > 0 ? CoveredRegion(points, distance / 2) : CoveredRegion();
}

LensCoverage CoverageOf(std::span<const Vec2> points, const Aperture& aperture) {
  constexpr int kSamples = 256;
  const double distance = DistanceOfMost(points);
  if (distance == 0) return {};
  const PointGrid grid(points);
  // By default (LensWeights::kAuto), a lens that is narrower than `distance` is weighted by hats,
  // which the region does not clip.
  const bool is_cut = 2 * aperture.radius_w > distance;
  const CoveredRegion region = CoveredBy(points);
  const double far = kFarDistances * distance;
  const std::vector<Vec2> places = SampleLens(aperture, aperture.radius_w > 0 ? kSamples : 1);
  const auto uncovered = std::count_if(places.begin(), places.end(), [&](const Vec2& place) {
    return (is_cut && !region.Contains(place)) || grid.DistanceToNearest(place) > far;
  });
  return {static_cast<double>(uncovered) / static_cast<double>(places.size()),
          2 * region.LargestRadius_w()};
}

}  // namespace lf
