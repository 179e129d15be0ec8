// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_plane.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lf/core/median.h"
#include "lf/densify/natural_neighbours.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

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
  const double radius = Median(std::move(radii));
  for (const Vec3& centre : centres) {
    const Vec3 direction = axes * (centre - subject).normalized();
    const double arc = std::acos(std::clamp(-direction.z(), -1.0, 1.0));
    if (DegreesFromRadians(arc) > kMostArc_deg)
      return InputError(fmt::format(
          "LF cameras surround the scene: one is {:.0f} degrees away from their middle, expected "
          "at most {:.0f}; densify each side by itself ({{lfimport exclude}} leaves LF images out)",
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
        "point: use parts of the light field that look in one direction ({{lfimport exclude}})",
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
  const double median = Median(usual);
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

}  // namespace lf
