// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/shot.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lf {

double VisibleMovement(const Shot& shot, const CameraMove& move) {
  const Vec3 to_subject = shot.SubjectWorld() - move.keys_world.front();
  const double distance_w = to_subject.norm();
  double most_px = 0;
  for (const Vec3& key : move.keys_world) {
    const Vec3 step = key - move.keys_world.front();
    const double ahead_w = step.dot(to_subject) / distance_w;
    const double aside_w = std::sqrt(std::max(0.0, step.squaredNorm() - ahead_w * ahead_w));
    most_px = std::max(
        most_px,
        (shot.frame.fx_px * aside_w + shot.frame.width_px / 2.0 * std::abs(ahead_w)) / distance_w);
  }
  return most_px;
}

std::string CropWords(double crop) {
  if (crop == 1) return "";
  return fmt::format(
      "; the frames are {:.0f} % as wide as a standing camera's, because LF cameras have not "
      "recorded wider ones",
      100 * crop);
}

Reach ReachNear(const LightField& light_field, const PinholeCamera& camera, double radius_w) {
  std::vector<double> right_w, up_w;
  for (const LfCamera& other : light_field.cameras) {
    const Vec3 offset = other.cam_from_world.Inverse().translation - camera.CentreWorld();
    if (offset.norm() > radius_w) continue;
    right_w.push_back(std::abs(camera.RightWorld().dot(offset)));
    up_w.push_back(std::abs(camera.UpWorld().dot(offset)));
  }
  const auto most = [](std::vector<double>* values) {
    constexpr double kShare = 0.95;  // without single LF cameras that stand apart
    const auto at = values->begin() +
                    static_cast<std::ptrdiff_t>(kShare * static_cast<double>(values->size() - 1));
    std::nth_element(values->begin(), at, values->end());
    return *at;
  };
  return {most(&right_w), most(&up_w)};
}

bool StandInARow(const LightField& light_field, const PinholeCamera& camera, double radius_w) {
  constexpr int kFewest = 3;
  constexpr double kMostAcross = 0.2;  // spread across the row, as a share of that along it
  int count = 0;
  Vec2 sum = Vec2::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (const LfCamera& other : light_field.cameras) {
    const Vec3 offset = other.cam_from_world.Inverse().translation - camera.CentreWorld();
    if (offset.norm() > radius_w) continue;
    const Vec2 at(camera.RightWorld().dot(offset), camera.UpWorld().dot(offset));
    ++count;
    sum += at;
    squares += at * at.transpose();
  }
  if (count < kFewest) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(squares -
                                                             sum * sum.transpose() / count);
  const Vec2 spread = eigen.eigenvalues();
  return spread[0] <= kMostAcross * kMostAcross * spread[1];
}

}  // namespace lf
