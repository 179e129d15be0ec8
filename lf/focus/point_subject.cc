// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/point_subject.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/focus/best_depths.h"

namespace lf {

namespace {

constexpr size_t kLeastPoints = 24;

// Returns the depths and weights of the points that the image shows, unsorted.
std::vector<FoundDepth> DepthsOf(const PinholeCamera& camera, std::span<const Vec3> points_world) {
  const Intrinsics& k = camera.intrinsics;
  const RayThrough rays(camera, camera.ForwardWorld());
  std::vector<FoundDepth> found;
  for (const Vec3& point : points_world) {
    const Vec3 direction = point - rays.centre_world();
    const double depth_w = camera.ForwardWorld().dot(direction);
    const std::optional<Vec2> at = rays.RecordedAt(direction);
    if (!(depth_w > 0) || !at || at->x() < 0 || at->y() < 0 || at->x() > k.width_px ||
        at->y() > k.height_px)
      continue;
    const Vec2 off = (*at - Vec2(k.width_px, k.height_px) / 2) / (0.5 * k.width_px);
    // Standard deviation of the weight, as a share of half the image's width, as in FindSubject().
    constexpr double kMiddle = 0.5;
    found.push_back({depth_w, std::exp(-0.5 * off.squaredNorm() / (kMiddle * kMiddle)), 0});
  }
  return found;
}

}  // namespace

Subject FindPointSubject(const PinholeCamera& camera, std::span<const Vec3> points_world) {
  std::vector<FoundDepth> found = DepthsOf(camera, points_world);
  Subject subject;
  subject.textured_count = subject.place_count = found.size();
  if (found.empty()) return subject;
  std::sort(found.begin(), found.end(), [](const FoundDepth& a, const FoundDepth& b) {
    return std::pair(a.distance_w, a.weight) < std::pair(b.distance_w, b.weight);
  });
  subject.near_w = found[found.size() / 10].distance_w;
  subject.far_w = found[found.size() - 1 - found.size() / 10].distance_w;
  for (auto one = found.rbegin(); one != found.rend(); ++one)
    subject.per_w.push_back(1 / one->distance_w);
  subject.depths = BestDepths(std::move(found));
  constexpr double kLeastShare = 0.25, kClear = 1.5;
  const double rival = subject.depths.size() > 1 ? subject.depths[1].share : 0;
  const SubjectDepth& best = subject.depths[0];
  subject.is_sure =
      best.place_count >= kLeastPoints && best.share >= kLeastShare && best.share >= kClear * rival;
  return subject;
}

bool PointsContradict(const PinholeCamera& camera, std::span<const Vec3> points_world,
                      double depth_w) {
  constexpr double kNear = 0.1, kMostNear = 0.01;
  const std::vector<FoundDepth> found = DepthsOf(camera, points_world);
  const auto near_count = std::count_if(found.begin(), found.end(), [&](const FoundDepth& one) {
    return std::abs(one.distance_w - depth_w) < kNear * depth_w;
  });
  return found.size() >= kLeastPoints &&
         static_cast<double>(near_count) <= kMostNear * static_cast<double>(found.size());
}

}  // namespace lf
