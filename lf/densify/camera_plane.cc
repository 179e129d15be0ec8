// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_plane.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lf/core/median.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

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

}  // namespace lf
