// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/orbit_coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "lf/camera/ray_through.h"

namespace lf {
namespace {

constexpr double kMostUnseen = 0.01;
constexpr size_t kMostCameras = 400;  // as many as the reach of the capture is measured with
constexpr int kPoints = 8;            // steps between tested elements, across and down
constexpr int kPositions = 2 * kOrbitKeys;

class OrbitCoverage {
 public:
  OrbitCoverage(const LightField& light_field, const OrbitWish& wish)
      : wish_(wish),
        target_world_(wish.start.CentreWorld() + wish.focus_distance_w * wish.start.ForwardWorld()),
        radius_w_(std::max(wish.lens_radius_w, wish.spacing_w)) {
    std::vector<uint32_t> ids(light_field.size());
    std::iota(ids.begin(), ids.end(), 0u);
    const Vec3 centre = wish.start.CentreWorld();
    const auto distance = [&](uint32_t id) {
      return (light_field.Camera(LfImageId{id}).CentreWorld() - centre).squaredNorm();
    };
    const size_t count = std::min(kMostCameras, ids.size());
    std::partial_sort(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), ids.end(),
                      [&](uint32_t a, uint32_t b) { return distance(a) < distance(b); });
    for (size_t i = 0; i < count; ++i) {
      const PinholeCamera camera = light_field.Camera(LfImageId{ids[i]});
      cameras_.emplace_back(camera, camera.ForwardWorld());
    }
  }

  // Returns the share of the tested elements of the worst frame that nobody has recorded.
  double Unseen(double scale, double crop) const {
    double worst = 0;
    for (int i = 0; i < kPositions; ++i)
      worst = std::max(worst, UnseenAt(OrbitPosition(wish_, scale, i / double{kPositions}), crop));
    return worst;
  }

 private:
  double UnseenAt(const Vec3& position_world, double crop) const {
    const std::optional<RigidTransform> pose =
        LookAlong(position_world, target_world_ - position_world, wish_.up_world);
    if (!pose) return 1;
    const PinholeCamera frame{wish_.frame, *pose};
    int unseen = 0;
    for (int j = 0; j <= kPoints; ++j)
      for (int i = 0; i <= kPoints; ++i) {
        const double x = (0.5 + crop * (i / double{kPoints} - 0.5)) * wish_.frame.width_px;
        const double y = (0.5 + crop * (j / double{kPoints} - 0.5)) * wish_.frame.height_px;
        unseen += IsSeen(frame, RayOfPixel(frame, x, y)) ? 0 : 1;
      }
    return unseen / double{(kPoints + 1) * (kPoints + 1)};
  }

  // Returns true if an LF camera has recorded the ray of an element, or one that passes near it
  // through the lens.
  bool IsSeen(const PinholeCamera& frame, const Ray& ray) const {
    const Vec3 forward = frame.ForwardWorld(), lens = frame.CentreWorld();
    const double focus_w = forward.dot(target_world_ - lens);
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

  const OrbitWish& wish_;
  Vec3 target_world_;
  double radius_w_;
  std::vector<RayThrough> cameras_;
};

}  // namespace

Vec3 OrbitPosition(const OrbitWish& wish, double scale, double turn) {
  const double angle = 2 * kPi * turn;
  return wish.start.CentreWorld() +
         scale * wish.right_w * (std::cos(angle) - 1) * wish.start.RightWorld() +
         scale * wish.up_w * std::sin(angle) * wish.start.UpWorld();
}

Orbit ChooseOrbit(const LightField& light_field, const OrbitWish& wish) {
  const OrbitCoverage coverage(light_field, wish);
  Orbit best;
  best.unseen = best.unseen_of_largest = coverage.Unseen(1, 1);
  if (best.unseen <= kMostUnseen) return best;
  constexpr double kScales[] = {1, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05};
  constexpr double kCrops[] = {1, 0.9, 0.8, 0.7};
  for (const double scale : kScales)
    for (const double crop : kCrops) {
      const bool is_good = best.unseen <= kMostUnseen;
      if (is_good && scale * crop <= best.scale * best.crop) continue;
      const double unseen = coverage.Unseen(scale, crop);
      if (is_good ? unseen > kMostUnseen : unseen >= best.unseen) continue;
      best.scale = scale;
      best.crop = crop;
      best.unseen = unseen;
    }
  return best;
}

}  // namespace lf
