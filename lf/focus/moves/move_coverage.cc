// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/move_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace lf {

MoveCoverage::MoveCoverage(const LightField& light_field, std::span<const LfImageId> cameras,
                           const Shot& shot, double radius_w)
    : shot_(shot), subject_world_(shot.SubjectWorld()), radius_w_(radius_w) {
  for (const LfImageId id : cameras) {
    const PinholeCamera camera = light_field.Camera(id);
    cameras_.emplace_back(camera, camera.ForwardWorld());
  }
}

double MoveCoverage::Unseen(const Vec3& position_world, double crop) const {
  constexpr int kSteps = 8;  // between tested elements, across and down
  const std::optional<RigidTransform> pose =
      LookAlong(position_world, subject_world_ - position_world, shot_.up_world);
  if (!pose) return 1;
  const PinholeCamera frame{shot_.frame, *pose};
  int unseen = 0;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const double x = (0.5 + crop * (i / double{kSteps} - 0.5)) * shot_.frame.width_px;
      const double y = (0.5 + crop * (j / double{kSteps} - 0.5)) * shot_.frame.height_px;
      unseen += IsSeen(frame, RayOfPixel(frame, x, y)) ? 0 : 1;
    }
  return unseen / double{(kSteps + 1) * (kSteps + 1)};
}

// Returns true if an LF camera has recorded the ray of an element, or one that passes near it
// through the lens.
bool MoveCoverage::IsSeen(const PinholeCamera& frame, const Ray& ray) const {
  const Vec3 forward = frame.ForwardWorld(), lens = frame.CentreWorld();
  const double focus_w = forward.dot(subject_world_ - lens);
  const Vec3 point = lens + ray.direction * (focus_w / forward.dot(ray.direction));
  return std::any_of(cameras_.begin(), cameras_.end(), [&](const RayThrough& camera) {
    const Vec3 to_camera = camera.centre_world() - point;
    const double back_w = -forward.dot(to_camera);
    if (!(back_w > 0)) return false;  // the LF camera stands behind the focus plane
    const Vec3 in_lens = point + to_camera * (focus_w / back_w);
    if ((in_lens - lens).squaredNorm() > radius_w_ * radius_w_) return false;
    constexpr double kTolerance_px = 0.5;
    const auto at = camera.RecordedAt(Vec3(-to_camera));
    return at && at->x() >= -kTolerance_px && at->y() >= -kTolerance_px &&
           at->x() <= camera.intrinsics().width_px + kTolerance_px &&
           at->y() <= camera.intrinsics().height_px + kTolerance_px;
  });
}

MoveCoverage CoverageNear(const LightField& light_field, const Shot& shot, double way_w) {
  const Vec3 start = shot.start.CentreWorld();
  double radius_w = std::max(shot.lens_radius_w, shot.spacing_w);
  std::vector<LfImageId> cameras;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if ((light_field.Camera({i}).CentreWorld() - start).norm() <= way_w + 2 * radius_w)
      cameras.push_back({i});
  const double share = double{kMostCoverageCameras} / static_cast<double>(cameras.size());
  if (share >= 1) return {light_field, cameras, shot, radius_w};
  // Every n-th LF camera would be one column of a grid. The multiples of the golden ratio are
  // spread evenly.
  constexpr double kGoldenRatio = 1.618033988749895, kMostGap = 2;
  std::erase_if(cameras, [&](LfImageId id) {
    const double multiple = kGoldenRatio * id.value;
    return multiple - std::floor(multiple) >= share;
  });
  radius_w = std::max(radius_w, kMostGap * shot.spacing_w / std::sqrt(share));
  return {light_field, cameras, shot, radius_w};
}

}  // namespace lf
