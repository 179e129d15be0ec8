// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// The numbers of rows and columns of a rig. Their product is near the wanted number of cameras.
struct Grid {
  uint32_t rows = 1;
  uint32_t columns = 1;
};

Grid GridOf(const RigOptions& options) {
  const uint32_t rows =
      options.shape == RigShape::kBand
          ? std::min<uint32_t>(3, options.count)
          : static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(options.count))));
  const double columns = std::round(static_cast<double>(options.count) / rows);
  return {rows, std::max(1U, static_cast<uint32_t>(columns))};
}

// Returns the pose of camera `index` with the jitter that RigOptions::jitter describes.
RigidTransform ShakenPose(const RigOptions& options, uint32_t index, const RigidTransform& pose) {
  if (options.jitter == 0) return pose;
  const auto shake = [&](uint64_t axis) {
    return options.jitter * (2 * RandomUnit(options.seed, index, axis) - 1);
  };
  const Vec3 turn = RadiansFromDegrees(1) * Vec3(shake(3), shake(4), shake(5));
  const Mat3 turned =
      (Eigen::AngleAxisd(turn.x(), Vec3::UnitX()) * Eigen::AngleAxisd(turn.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(turn.z(), Vec3::UnitZ()))
          .toRotationMatrix();
  const Vec3 move = RigPitch(options) * Vec3(shake(0), shake(1), shake(2));
  return RigidTransform{turned, -(turned * move)} * pose;
}

std::vector<RigidTransform> PlanarPoses(const RigOptions& options) {
  const Grid grid = GridOf(options);
  const Vec3 middle = options.target_world - options.distance_w * options.view_world.normalized();
  const RigidTransform facing = *LookAlong(middle, options.view_world, options.up_world);
  std::vector<RigidTransform> poses;
  poses.reserve(static_cast<size_t>(grid.rows) * grid.columns);
  for (uint32_t row = 0; row < grid.rows; ++row)
    for (uint32_t column = 0; column < grid.columns; ++column) {
      const Vec3 place(options.spacing_w * (column - 0.5 * (grid.columns - 1)),
                       options.spacing_w * (row - 0.5 * (grid.rows - 1)), 0);
      poses.push_back({facing.rotation, facing.translation - place});
    }
  return poses;
}

std::vector<RigidTransform> BandPoses(const RigOptions& options) {
  const Grid grid = GridOf(options);
  const double step_rad = options.spacing_w / options.distance_w;
  const Vec3 up = options.up_world.normalized();
  std::vector<RigidTransform> poses;
  poses.reserve(static_cast<size_t>(grid.rows) * grid.columns);
  for (uint32_t row = 0; row < grid.rows; ++row)
    for (uint32_t column = 0; column < grid.columns; ++column) {
      const double angle = step_rad * (column - 0.5 * (grid.columns - 1));
      const Vec3 back =
          Eigen::AngleAxisd(angle, up) * (-options.distance_w * options.view_world.normalized());
      const double lift_w = options.spacing_w * (0.5 * (grid.rows - 1) - row);
      const Vec3 centre = options.target_world + back + lift_w * up;
      poses.push_back(*LookAlong(centre, options.target_world - centre, up));
    }
  return poses;
}

// Returns poses on a dome, along Fibonacci's spiral: from each camera to the next, the height
// changes by an equal step, and the direction rotates by the golden angle.
std::vector<RigidTransform> HemispherePoses(const RigOptions& options) {
  const Vec3 up = options.up_world.normalized();
  const Vec3 right = options.view_world.cross(up).normalized();
  const Vec3 away = right.cross(up);
  const double golden_angle = kPi * (3 - std::sqrt(5.0));
  std::vector<RigidTransform> poses;
  poses.reserve(options.count);
  for (uint32_t i = 0; i < options.count; ++i) {
    const double height = 1 - (i + 0.5) / options.count;
    const double round = std::sqrt(1 - height * height);
    const Vec3 out = height * up + round * (std::cos(golden_angle * i) * right +
                                            std::sin(golden_angle * i) * away);
    poses.push_back(*LookAlong(options.target_world + options.distance_w * out, -out, up));
  }
  return poses;
}

Result<void> CheckOptions(const RigOptions& options) {
  if (options.count == 0)
    return UsageError("a rig of 0 cameras takes no picture; give 1 or more ({count})");
  constexpr double kLongest_w = 1e6;  // calibrations hold the positions of all rigs up to here
  const bool pitched = options.shape != RigShape::kHemisphere;
  if (pitched && !(options.spacing_w > 0 && options.spacing_w <= kLongest_w))
    return UsageError(fmt::format(
        "camera spacing {} ({{spacing}}): expected a positive length of at most {} world units",
        options.spacing_w, kLongest_w));
  if (!(options.distance_w > 0 && options.distance_w <= kLongest_w))
    return UsageError(
        fmt::format("distance {} of the cameras from the scene ({{distance}}): expected a positive "
                    "length of at most {} world units",
                    options.distance_w, kLongest_w));
  if (!(options.jitter >= 0 && options.jitter <= 1))
    return UsageError(
        fmt::format("jitter {} ({{jitter}}): expected a share of the camera spacing from 0 to 1",
                    options.jitter));
  if (!LookAlong(Vec3::Zero(), options.view_world, options.up_world))
    return UsageError(fmt::format(
        "view direction {} {} {}: expected a direction that is not 0 and not parallel to the up "
        "direction {} {} {}",
        options.view_world.x(), options.view_world.y(), options.view_world.z(),
        options.up_world.x(), options.up_world.y(), options.up_world.z()));
  const double arc_rad = options.spacing_w / options.distance_w * GridOf(options).columns;
  if (options.shape == RigShape::kBand && arc_rad > 2 * kPi)
    return UsageError(fmt::format(
        "a band of {} columns of cameras {} world units apart is longer than its circle of radius "
        "{} world units: lower {{count}} or {{spacing}}, or raise {{distance}}",
        GridOf(options).columns, options.spacing_w, options.distance_w));
  return {};
}

}  // namespace

double RigPitch(const RigOptions& options) {
  if (options.shape != RigShape::kHemisphere) return options.spacing_w;
  return options.distance_w * std::sqrt(2 * kPi / std::max(1U, options.count));
}

Result<std::vector<RigidTransform>> MakeRig(const RigOptions& options) {
  LF_RETURN_IF_ERROR(CheckOptions(options));
  std::vector<RigidTransform> poses = options.shape == RigShape::kPlanar ? PlanarPoses(options)
                                      : options.shape == RigShape::kBand ? BandPoses(options)
                                                                         : HemispherePoses(options);
  for (uint32_t i = 0; i < poses.size(); ++i) poses[i] = ShakenPose(options, i, poses[i]);
  return poses;
}

}  // namespace lf
