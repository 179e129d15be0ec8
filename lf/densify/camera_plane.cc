#include "lf/densify/camera_plane.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

// A convex polygon that remembers which clip made each of its sides.
class Cell {
 public:
  static constexpr uint32_t kBorder = UINT32_MAX;

  explicit Cell(double half_side)
      : corners_{{{-half_side, -half_side}, kBorder},
                 {{half_side, -half_side}, kBorder},
                 {{half_side, half_side}, kBorder},
                 {{-half_side, half_side}, kBorder}} {}

  struct Corner {
    Vec2 at;
    uint32_t side = kBorder;  // the clip that made the side from this corner to the next
  };
  const std::vector<Corner>& corners() const { return corners_; }

  // Keeps the points that are nearer to 0 than to `point`.
  void ClipBy(const Vec2& point, uint32_t index) {
    const double offset = point.squaredNorm() / 2;
    const auto beyond = [&](const Vec2& at) { return point.dot(at) - offset; };
    std::vector<Corner> kept;
    for (size_t i = 0; i < corners_.size(); ++i) {
      const Corner& here = corners_[i];
      const Corner& next = corners_[(i + 1) % corners_.size()];
      const double a = beyond(here.at), b = beyond(next.at);
      if (a <= 0) kept.push_back(here);
      if ((a <= 0) == (b <= 0)) continue;
      const Vec2 cut = here.at + (next.at - here.at) * (a / (a - b));
      kept.push_back({cut, a <= 0 ? index : here.side});
    }
    corners_ = std::move(kept);
  }
  double Reach() const {
    double reach = 0;
    for (const Corner& corner : corners_) reach = std::max(reach, corner.at.norm());
    return reach;
  }

 private:
  std::vector<Corner> corners_;  // counter-clockwise
};

struct Box {
  Vec2 least, most;
};
Box BoxOf(std::span<const Vec2> points) {
  Box box{points[0], points[0]};
  for (const Vec2& point : points) {
    box.least = box.least.cwiseMin(point);
    box.most = box.most.cwiseMax(point);
  }
  return box;
}

// Returns the corners of the convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Vec2> HullOf(std::span<const Vec2> points) {
  std::vector<Vec2> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vec2> hull;
  for (int half = 0; half < 2; ++half) {
    const size_t begin = hull.size();
    for (const Vec2& point : sorted) {
      while (hull.size() >= begin + 2 &&
             Cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(sorted.begin(), sorted.end());
  }
  return hull;
}

// Returns the point on the border of a polygon that is nearest to `place`.
Vec2 NearestOn(std::span<const Vec2> polygon, const Vec2& place) {
  Vec2 nearest = polygon[0];
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double along = (place - polygon[i]).dot(side) / side.squaredNorm();
    const Vec2 point = polygon[i] + std::clamp(along, 0.0, 1.0) * side;
    if ((point - place).norm() < (nearest - place).norm()) nearest = point;
  }
  return nearest;
}

// Returns the points in the order of their distance from `place`.
std::vector<uint32_t> ByDistance(std::span<const Vec2> points, const Vec2& place) {
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return (points[a] - place).squaredNorm() < (points[b] - place).squaredNorm();
  });
  return order;
}

// Returns the number of the direction, of eight, from one point to another.
int DirectionOf(const Vec2& offset) {
  const double turn = std::atan2(offset.y(), offset.x()) / kPi * 4;
  return static_cast<int>(std::floor(turn + 8.5)) % 8;
}

// Puts the LF cameras on a sphere around the subject, and unrolls it.
Result<void> Unroll(std::span<const Vec3> centres, const Vec3& subject, CameraPlane* plane) {
  constexpr double kMostArc_deg = 140;
  const Mat3& axes = plane->mean_cam_from_world.rotation;
  std::vector<double> radii;
  for (const Vec3& centre : centres) radii.push_back((centre - subject).norm());
  std::nth_element(radii.begin(), radii.begin() + static_cast<long>(radii.size() / 2), radii.end());
  const double radius = radii[radii.size() / 2];
  for (const Vec3& centre : centres) {
    const Vec3 direction = axes * (centre - subject).normalized();
    const double arc = std::acos(std::clamp(-direction.z(), -1.0, 1.0));
    if (DegreesFromRadians(arc) > kMostArc_deg)
      return InputError(fmt::format(
          "LF cameras surround the scene: one is {:.0f} degrees away from their middle, expected "
          "at most {:.0f}; densify each side by itself (lfimport --exclude leaves LF images out)",
          DegreesFromRadians(arc), kMostArc_deg));
    const double across = direction.head<2>().norm();
    plane->points.push_back(across > 0 ? Vec2(direction.head<2>() / across * (arc * radius))
                                       : Vec2(Vec2::Zero()));
  }
  return {};
}

}  // namespace

Mat3 MeanRotation(std::span<const Mat3> rotations, std::span<const double> weights) {
  Mat3 sum = Mat3::Zero();
  for (size_t i = 0; i < rotations.size(); ++i) sum += weights[i] * rotations[i];
  const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 sign = Mat3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

Result<CameraPlane> CameraPlaneOf(const LightField& light_field) {
  CameraPlane plane;
  std::vector<Mat3> rotations;
  std::vector<Vec3> centres;
  Vec3 middle = Vec3::Zero();
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const PinholeCamera camera = light_field.Camera(LfImageId{i});
    rotations.push_back(camera.cam_from_world.rotation);
    centres.push_back(camera.CentreWorld());
    middle += centres.back() / static_cast<double>(light_field.size());
  }
  const std::vector<double> equal(rotations.size(), 1.0);
  const Mat3 mean = MeanRotation(rotations, equal);
  plane.mean_cam_from_world = {mean, -(mean * middle)};
  for (const Mat3& rotation : rotations)
    plane.widest_deg = std::max(
        plane.widest_deg,
        DegreesFromRadians(std::acos(std::clamp(rotation.row(2).dot(mean.row(2)), -1.0, 1.0))));
  plane.is_unrolled = plane.widest_deg > kMostTurn_deg;
  if (!plane.is_unrolled) {
    for (const Vec3& centre : centres)
      plane.points.push_back((plane.mean_cam_from_world * centre).head<2>());
    return plane;
  }
  const std::optional<Vec3> subject = AxesMeetingPoint(light_field);
  if (!subject)
    return InputError(fmt::format(
        "LF cameras look up to {:.0f} degrees away from their mean direction, and not at one "
        "point: densify parts of the light field that look in one direction (lfimport --exclude)",
        plane.widest_deg));
  LF_RETURN_IF_ERROR(Unroll(centres, *subject, &plane));
  return plane;
}

std::vector<std::vector<uint32_t>> CompareWith(std::span<const Vec2> points) {
  constexpr size_t kLeast = 4, kUsual = 3;
  constexpr double kFarthest = 4;
  std::vector<std::vector<uint32_t>> orders;
  std::vector<double> usual;
  for (const Vec2& point : points) {
    orders.push_back(ByDistance(points, point));
    const uint32_t other = orders.back()[std::min(kUsual, points.size() - 1)];
    usual.push_back((points[other] - point).norm());
  }
  std::vector<double> sorted = usual;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];
  std::vector<std::vector<uint32_t>> result;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::vector<uint32_t>& order = orders[i];
    std::vector<uint32_t> chosen;
    bool has[8] = {};
    double nearest = 0;
    for (const uint32_t other : order) {
      const Vec2 offset = points[other] - points[i];
      const double distance = offset.norm();
      if (distance == 0) continue;
      if (nearest == 0) nearest = distance;
      if (distance > kFarthest * std::max(median, nearest) && chosen.size() >= 2) break;
      bool& is_taken = has[DirectionOf(offset)];
      if (!is_taken) chosen.push_back(other);
      is_taken = true;
    }
    for (size_t k = 0; k < order.size() && chosen.size() < kLeast; ++k)
      if ((points[order[k]] - points[i]).norm() > 0 &&
          std::find(chosen.begin(), chosen.end(), order[k]) == chosen.end())
        chosen.push_back(order[k]);
    result.push_back(std::move(chosen));
  }
  return result;
}

std::vector<WeightedPoint> NaturalNeighbours(std::span<const Vec2> points, const Vec2& place) {
  const Box box = BoxOf(points);
  const double extent = (box.most - box.least).norm();
  // Cells of places inside the hull end far within this square.
  constexpr double kFar = 1e4, kSame = 1e-9;
  Cell cell(kFar * extent);
  for (const uint32_t i : ByDistance(points, place)) {
    const Vec2 offset = points[i] - place;
    const double distance = offset.norm();
    if (distance <= kSame * extent) return {{i, 1}};
    if (distance > 2 * cell.Reach()) break;
    cell.ClipBy(offset, i);
  }
  std::vector<WeightedPoint> found;
  double sum = 0;
  const std::vector<Cell::Corner>& corners = cell.corners();
  for (size_t k = 0; k < corners.size(); ++k) {
    const uint32_t side = corners[k].side;
    if (side == Cell::kBorder) return {};
    const double length = (corners[(k + 1) % corners.size()].at - corners[k].at).norm();
    const double weight = length / (points[side] - place).norm();
    found.push_back({side, weight});
    sum += weight;
  }
  for (WeightedPoint& point : found) point.weight /= sum;
  std::stable_sort(found.begin(), found.end(), [](const WeightedPoint& a, const WeightedPoint& b) {
    return a.weight > b.weight;
  });
  return found;
}

std::vector<LatticePlace> LatticeAmong(std::span<const Vec2> points, double distance,
                                       double outside) {
  constexpr double kRow = 0.86602540378443865;
  // Natural neighbours exist only strictly inside the hull.
  constexpr double kInwards = 1e-3;
  const std::vector<Vec2> hull = HullOf(points);
  const Vec2 middle = std::accumulate(hull.begin(), hull.end(), Vec2(Vec2::Zero())) /
                      static_cast<double>(hull.size());
  const Box box = BoxOf(points);
  std::vector<LatticePlace> lattice;
  int row = 0;
  for (double y = box.least.y() - outside; y <= box.most.y() + outside; y += kRow * distance, ++row)
    for (double x = box.least.x() - outside + (row % 2) * distance / 2; x <= box.most.x() + outside;
         x += distance) {
      LatticePlace at{{x, y}, {x, y}, {}};
      const auto is_near = [&](const Vec2& point) {
        return (point - at.place).norm() < distance / 2;
      };
      if (std::any_of(points.begin(), points.end(), is_near)) continue;
      at.neighbours = NaturalNeighbours(points, at.place);
      if (at.neighbours.empty()) {
        const Vec2 edge = NearestOn(hull, at.place);
        if ((edge - at.place).norm() > outside) continue;
        at.inside = edge + kInwards * (middle - edge);
        at.neighbours = NaturalNeighbours(points, at.inside);
      }
      if (!at.neighbours.empty()) lattice.push_back(std::move(at));
    }
  return lattice;
}

double MedianDistance(std::span<const Vec2> points) {
  std::vector<double> distances;
  for (size_t i = 0; i < points.size(); ++i) {
    double nearest = INFINITY;
    for (size_t j = 0; j < points.size(); ++j)
      if (j != i) nearest = std::min(nearest, (points[j] - points[i]).norm());
    distances.push_back(nearest);
  }
  std::nth_element(distances.begin(), distances.begin() + static_cast<long>(distances.size() / 2),
                   distances.end());
  return distances[distances.size() / 2];
}

}  // namespace lf
