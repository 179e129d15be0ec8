// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/lens_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lf/core/check.h"
#include "lf/selection/lens_weights/lens_cell.h"

namespace lf {
namespace {

// Half the side of the square that a cell is first cut from, in buckets of the grid.
constexpr double kNearBuckets = 3;

// Finds the natural neighbours of a place, and the area that a cell of this place would take from
// each of them.
class HatMaker {
 public:
  explicit HatMaker(std::span<const Vec2> points) : points_(points), grid_(points) {}

  void AddAt(const Vec2& place, double share, std::vector<double>* shares) {
    neighbours_.clear();
    same_.clear();
    ConvexPolygon cell = Surroundings(place);
    CutCell(
        place, points_, grid_, [this](size_t i) { neighbours_.push_back(i); },
        [this](size_t i) { same_.push_back(i); }, &cell);
    if (!same_.empty()) {
      for (const size_t i : same_) (*shares)[i] += share / static_cast<double>(same_.size());
      return;
    }
    AddThoseAtTheSamePlaces();
    taken_.clear();
    double total = 0;
    for (const size_t i : neighbours_) {
      taken_.push_back(TakenFrom(i, cell));
      total += taken_.back();
    }
    for (size_t k = 0; k < neighbours_.size(); ++k)
      (*shares)[neighbours_[k]] += share * taken_[k] / total;
  }

 private:
  // Adds the points that are at the same place as a neighbour. They are neighbours, too, although
  // CutCell() does not report them, because they cut nothing more off.
  void AddThoseAtTheSamePlaces() {
    const size_t met_count = neighbours_.size();
    for (size_t k = 0; k < met_count; ++k)
      grid_.ForEachInRing(points_[neighbours_[k]], 0, [&](size_t i) {
        if (points_[i] == points_[neighbours_[k]] &&
            std::find(neighbours_.begin(), neighbours_.end(), i) == neighbours_.end())
          neighbours_.push_back(i);
      });
  }

  // Returns a polygon that limits the cell, because a cell beside all cameras would be infinite. A
  // cell between cameras is smaller than the polygon.
  ConvexPolygon Surroundings(const Vec2& place) const {
    constexpr double kFar = 8;
    return ConvexPolygon::SquareAround(
        place, kFar * (grid_.DistanceToNearest(place) + grid_.bucket_size()));
  }

  // Returns the area that `cell` takes from neighbour i, divided by the number of points at the
  // place of this neighbour.
  double TakenFrom(size_t i, const ConvexPolygon& cell) {
    int sharing = 1;
    part_ = cell;
    for (const size_t other : neighbours_) {
      if (other == i) continue;
      const Vec2 across = points_[other] - points_[i];
      if (across == Vec2::Zero())
        ++sharing;
      else
        part_.Clip(across, across.dot(0.5 * (points_[i] + points_[other])));
    }
    return part_.Area() / sharing;
  }

  std::span<const Vec2> points_;
  PointGrid grid_;
  std::vector<size_t> neighbours_;
  std::vector<size_t> same_;
  std::vector<double> taken_;
  ConvexPolygon part_;  // a member, so that its memory is reused
};

// Cuts `cell` down to the Voronoi cell of a point. Returns the number of points at this place,
// itself included; 0 if nothing of the cell is left.
int CutSharedCell(const Vec2& point, std::span<const Vec2> points, const PointGrid& grid,
                  ConvexPolygon* cell) {
  int sharing = 0;
  CutCell(
      point, points, grid, [](size_t) {}, [&](size_t) { ++sharing; }, cell);
  return sharing;
}

// For a point outside of the circle around the opening, returns the other point that is nearest to
// the place on this circle that is closest to `point`. Only the buckets around that place are
// searched. Returns nullopt if these contain no other point, or if `point` is in the circle.
std::optional<Vec2> PointAtRim(const Vec2& point, std::span<const Vec2> points,
                               const PointGrid& grid, double radius) {
  const double distance = point.norm();
  if (distance <= radius) return std::nullopt;
  const Vec2 rim = point * (radius / distance);
  std::optional<Vec2> nearest;
  for (int ring = 0; ring <= 1; ++ring)
    grid.ForEachInRing(rim, ring, [&](size_t i) {
      if (points[i] == point) return;
      if (!nearest || (points[i] - rim).squaredNorm() < (*nearest - rim).squaredNorm())
        nearest = points[i];
    });
  return nearest;
}

// Returns the shares of the points in an opening.
//   around    a polygon that contains the opening
//   radius_w  of a circle around the lens centre that contains the opening
//   area_of   returns the area of the part of a cell that lies in the opening
template <class AreaOf>
std::vector<double> SharesOf(std::span<const Vec2> points, ConvexPolygon around,
                             const CoveredRegion& covered, double radius_w, double opening_area,
                             const AreaOf& area_of) {
  covered.Clip(&around);
  const PointGrid grid(points);
  std::vector<double> shares;
  shares.reserve(points.size());
  for (const Vec2& point : points) {
    // Most points beside the opening have no cell in it, because a single other point near the rim
    // is nearer to every place of the opening. Clipping by that point first is quick.
    ConvexPolygon left = around;
    if (const std::optional<Vec2> rival = PointAtRim(point, points, grid, radius_w)) {
      const Vec2 across = *rival - point;
      left.Clip(across, across.dot(0.5 * (point + *rival)));
      if (left.empty()) {
        shares.push_back(0);
        continue;
      }
    }
    const int sharing = CutSharedCell(point, points, grid, &left);
    shares.push_back(area_of(left) / opening_area / std::max(1, sharing));
  }
  return shares;
}

}  // namespace

std::vector<double> CellShares(std::span<const Vec2> points, const Aperture& aperture,
                               const CoveredRegion& covered) {
  LF_CHECK(aperture.radius_w > 0);
  if (!aperture.IsDisk())
    return SharesOf(points, ConvexPolygon(Vertices(aperture)), covered, aperture.radius_w,
                    Area(aperture), [](const ConvexPolygon& cell) { return cell.Area(); });
  return SharesOf(points, ConvexPolygon::SquareAround(Vec2::Zero(), aperture.radius_w), covered,
                  aperture.radius_w, Area(aperture),
                  [&](const ConvexPolygon& cell) { return cell.AreaInDisk(aperture.radius_w); });
}

std::vector<double> CellShares(std::span<const Vec2> points, const ConvexPolygon& opening,
                               const CoveredRegion& covered, const PartMeasure& measure) {
  const double whole = opening.empty() ? 0 : measure(opening);
  if (whole == 0) return std::vector<double>(points.size(), 0);
  return SharesOf(points, opening, covered, opening.FarthestFrom(Vec2::Zero()), whole, measure);
}

std::vector<double> WholeCellShares(std::span<const Vec2> points, const Aperture& aperture,
                                    const CoveredRegion& covered) {
  LF_CHECK(aperture.radius_w > 0);
  double farthest_w = aperture.radius_w;
  for (const Vec2& point : points) farthest_w = std::max(farthest_w, point.norm());
  ConvexPolygon plane = ConvexPolygon::SquareAround(Vec2::Zero(), farthest_w);
  covered.Clip(&plane);
  // In the order of the grid, a point and its neighbours are near each other in memory.
  const std::vector<size_t> order = PointGrid(points).sorted();
  std::vector<Vec2> sorted;
  sorted.reserve(points.size());
  for (const size_t i : order) sorted.push_back(points[i]);
  const PointGrid grid(sorted);
  const double near_w = kNearBuckets * grid.bucket_size();
  std::vector<double> shares(points.size());
  for (size_t k = 0; k < sorted.size(); ++k) {
    // Nearly all cells are small, and cut from a small square more quickly than from the plane.
    const Vec2& point = sorted[k];
    ConvexPolygon cell = ConvexPolygon::SquareAround(point, near_w);
    int sharing = CutSharedCell(point, sorted, grid, &cell);
    const double reach_w = cell.FarthestFrom(point);
    const bool is_whole = reach_w < near_w && covered.ContainsDisk(point, reach_w) &&
                          point.cwiseAbs().maxCoeff() + reach_w <= farthest_w;
    if (!is_whole) {
      cell = plane;
      sharing = CutSharedCell(point, sorted, grid, &cell);
    }
    shares[order[k]] = cell.Area() / Area(aperture) / std::max(1, sharing);
  }
  return shares;
}

std::vector<double> HatShares(std::span<const Vec2> points, const Aperture& aperture,
                              int sample_count) {
  LF_CHECK(aperture.radius_w >= 0 && sample_count > 0);
  std::vector<LensPlace> places;
  for (const Vec2& place : SampleLens(aperture, aperture.radius_w == 0 ? 1 : sample_count))
    places.push_back({place});
  return HatShares(points, places);
}

std::vector<double> HatShares(std::span<const Vec2> points, std::span<const LensPlace> places) {
  std::vector<double> shares(points.size(), 0);
  if (points.empty() || places.empty()) return shares;
  double sum = 0;
  for (const LensPlace& place : places) sum += place.weight;
  HatMaker hats(points);
  for (const LensPlace& place : places) hats.AddAt(place.place, place.weight / sum, &shares);
  return shares;
}

std::vector<double> SpreadShares(std::span<const Vec2> points, std::span<const LensPlace> places,
                                 double spread_w) {
  std::vector<double> shares(points.size(), 0);
  if (points.empty() || places.empty()) return shares;
  LF_CHECK(spread_w > 0);
  // Points whose weight is less than e^-kFew of the nearest one's are left out.
  constexpr double kFew = 12;
  const double few_w2 = kFew * 2 * spread_w * spread_w;
  double sum = 0;
  for (const LensPlace& place : places) sum += place.weight;
  std::vector<double> of_place(points.size());  // squared distances, then weights
  for (const LensPlace& place : places) {
    double nearest_w2 = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < points.size(); ++i) {
      of_place[i] = (points[i] - place.place).squaredNorm();
      nearest_w2 = std::min(nearest_w2, of_place[i]);
    }
    double total = 0;
    for (double& weight : of_place) {
      const double more_w2 = weight - nearest_w2;
      weight = more_w2 > few_w2 ? 0 : std::exp(-kFew * more_w2 / few_w2);
      total += weight;
    }
    const double scale = place.weight / (sum * total);
    for (size_t i = 0; i < points.size(); ++i) shares[i] += scale * of_place[i];
  }
  return shares;
}

}  // namespace lf
