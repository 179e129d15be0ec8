#include "lf/lens_weights/lens_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lf/core/check.h"
#include "lf/lens_weights/convex_polygon.h"
#include "lf/lens_weights/point_grid.h"

namespace lf {
namespace {

// What is left of the opening, or of a polygon around it, by the bisectors with other points.
class Cell {
 public:
  Cell(const Vec2& point, const ConvexPolygon& opening) : point_(point), polygon_(opening) {}

  // The part that is no nearer to `other`. False if the two are the same.
  bool CutBy(const Vec2& other) {
    const Vec2 across = other - point_;
    if (across == Vec2::Zero()) return false;
    polygon_.Clip(across, across.dot(0.5 * (point_ + other)));
    reach_ = -1;
    return true;
  }

  const ConvexPolygon& polygon() const { return polygon_; }

  // How far a point may be to cut this further.
  double Reach() {
    if (reach_ < 0) reach_ = 2 * polygon_.FarthestFrom(point_);
    return reach_;
  }

 private:
  Vec2 point_;
  ConvexPolygon polygon_;
  double reach_ = -1;
};

}  // namespace

std::vector<double> LensCellAreas(std::span<const Vec2> points, const Aperture& aperture) {
  LF_CHECK(aperture.radius_w > 0);
  const bool is_disk = aperture.blades == 0;
  const ConvexPolygon opening =
      is_disk ? ConvexPolygon::SquareAround(aperture.radius_w) : ConvexPolygon(Vertices(aperture));
  const PointGrid grid(points);
  std::vector<double> areas;
  areas.reserve(points.size());
  for (const Vec2& point : points) {
    Cell cell(point, opening);
    int sharing = 0;  // points at this place, itself among them
    for (int ring = 0; ring <= grid.ring_count(); ++ring) {
      if (cell.polygon().empty() || grid.LeastDistanceOf(ring) > cell.Reach()) break;
      grid.ForEachInRing(point, ring, [&](const Vec2& other) {
        if (!cell.polygon().empty() && !cell.CutBy(other)) ++sharing;
      });
    }
    const double area =
        is_disk ? cell.polygon().AreaInDisk(aperture.radius_w) : cell.polygon().Area();
    areas.push_back(area / std::max(1, sharing));
  }
  return areas;
}

}  // namespace lf
