// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/swept_depths.h"

#include <fmt/format.h>

#include "lf/core/log.h"
#include "lf/focus/find_subject.h"

namespace lf {

LfImageId NearestCamera(const LightField& light_field, const Vec3& position_world) {
  LfImageId nearest{0};
  double nearest_w = -1;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const double away_w = (light_field.Camera(LfImageId{i}).CentreWorld() - position_world).norm();
    if (nearest_w >= 0 && away_w >= nearest_w) continue;
    nearest = LfImageId{i};
    nearest_w = away_w;
  }
  return nearest;
}

std::optional<DepthRange> SweptDepths(const LightField& light_field, const LfImageStore& store,
                                      const Vec3& position_world, ThreadPool& pool,
                                      std::string* why) {
  if (light_field.size() < 3) return std::nullopt;
  const Result<Subject> subject =
      FindSubject(light_field, store, NearestCamera(light_field, position_world), pool);
  if (!subject) {
    LogDebug("depths of the scene: {}", subject.error().message);
    if (why != nullptr) *why = subject.error().message;
    return std::nullopt;
  }
  constexpr double kMargin = 1.05;
  if (!subject->is_range_sure) {
    const size_t count = subject->missing.size();
    if (why != nullptr && count > 0)
      *why = fmt::format("{} LF image{} could not be loaded: {}", count, count == 1 ? "" : "s",
                         subject->missing.front());
    return std::nullopt;
  }
  return DepthRange{subject->near_w / kMargin, subject->far_w * kMargin};
}

}  // namespace lf
