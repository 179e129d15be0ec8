// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/place_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lf {
namespace {

constexpr double kLeastTolerance = 0.5, kMostTolerance = 2;  // in reduced pixels

// A camera after a repair, with the map of its lens.
struct Eye {
  explicit Eye(const PinholeCamera& camera)
      : k(camera.intrinsics),
        rotation(camera.cam_from_world.rotation),
        centre(camera.CentreWorld()),
        map(camera.intrinsics.distortion) {}

  // Returns the direction, in camera axes, of the ray that is recorded at a position.
  std::optional<Vec3> DirectionAt(const Vec2& at_px) const {
    const double y = (at_px.y() - k.cy_px) / k.fy_px;
    return map.Undistort({(at_px.x() - k.cx_px - k.skew_px * y) / k.fx_px, y});
  }
  // Returns the position at which a direction in camera axes is recorded.
  std::optional<Vec2> RecordedAt(const Vec3& direction) const {
    const std::optional<Vec2> at = map.Distort(direction);
    if (!at) return std::nullopt;
    return Vec2(k.fx_px * at->x() + k.skew_px * at->y() + k.cx_px, k.fy_px * at->y() + k.cy_px);
  }

  Intrinsics k;
  Mat3 rotation;
  Vec3 centre;
  DistortionMap map;
};

// Another LF image that shows a place: the point at inverse depth p has the direction
// far + p * step in its camera.
struct Seen {
  const Eye* eye;
  Vec3 far, step;
  Vec2 at_px;
};

double ErrorAt(const Seen& seen, double per_w) {
  const std::optional<Vec2> at = seen.eye->RecordedAt(seen.far + per_w * seen.step);
  return at ? std::min((*at - seen.at_px).norm(), 1e9) : 1e9;
}

}  // namespace

PlaceErrors::PlaceErrors(const LightField& light_field, const std::vector<SeenPlace>& places,
                         int divisor)
    : field_(light_field),
      places_(places),
      divisor_(divisor),
      is_rectified_(IsRectified(light_field)) {
  for (const SeenPlace& place : places_) {
    images_.push_back(place.from.image);
    for (const Sighting& other : place.others) images_.push_back(other.image);
  }
  std::sort(images_.begin(), images_.end());
  images_.erase(std::unique(images_.begin(), images_.end()), images_.end());
}

std::vector<PlaceError> PlaceErrors::Of(const Repair& repair, size_t step) const {
  const std::vector<uint32_t> camera_of = repair.names == NameOrder::kAsRecorded
                                              ? std::vector<uint32_t>()
                                              : CamerasOfImages(repair.names, field_.image_names);
  std::vector<std::optional<Eye>> eyes(images_.size());
  for (size_t i = 0; i < images_.size(); ++i) {
    const uint32_t camera = camera_of.empty() ? images_[i] : camera_of[images_[i]];
    if (camera != LfCamera::kNone)
      eyes[i].emplace(RepairedCamera(repair, field_.Camera({camera}), is_rectified_));
  }
  const auto eye_of = [&](uint32_t image) -> const std::optional<Eye>& {
    const auto at = std::lower_bound(images_.begin(), images_.end(), image);
    return eyes[static_cast<size_t>(at - images_.begin())];
  };
  std::vector<PlaceError> errors;
  for (size_t p = 0; p < places_.size(); p += step) {
    const SeenPlace& place = places_[p];
    const std::optional<Eye>& from = eye_of(place.from.image);
    const std::optional<Vec3> ray = from ? from->DirectionAt(place.from.at_px) : std::nullopt;
    double least = 1e9;
    if (ray) {
      const Vec3 direction = from->rotation.transpose() * ray->normalized();
      std::vector<Seen> others;
      std::vector<double> depths_per_w = {0};
      double above = 0, below = 0;
      for (const Sighting& other : place.others) {
        const std::optional<Eye>& eye = eye_of(other.image);
        if (!eye) continue;
        const Seen seen{&*eye, eye->rotation * direction,
                        eye->rotation * (from->centre - eye->centre), other.at_px};
        others.push_back(seen);
        const std::optional<Vec3> sight = eye->DirectionAt(other.at_px);
        if (!sight) continue;
        // The inverse depth for which the point is nearest to the line of sight.
        const Vec3 a = seen.far.cross(sight->normalized()),
                   b = seen.step.cross(sight->normalized());
        above -= a.dot(b);
        below += b.squaredNorm();
        if (b.squaredNorm() > 0 && -a.dot(b) > 0)
          depths_per_w.push_back(-a.dot(b) / b.squaredNorm());
      }
      if (below > 0 && above > 0) depths_per_w.push_back(above / below);
      std::vector<double> each(others.size());
      const size_t rank = others.empty() ? 0 : (3 * others.size() + 3) / 4 - 1;
      for (const double per_w : depths_per_w) {
        if (others.empty()) break;
        for (size_t i = 0; i < others.size(); ++i) each[i] = ErrorAt(others[i], per_w);
        std::nth_element(each.begin(), each.begin() + static_cast<ptrdiff_t>(rank), each.end());
        least = std::min(least, each[rank]);
      }
    }
    errors.push_back(
        {std::min(least / divisor_, PlaceError::kMost),
         std::clamp(0.25 * LongestMove(place) / divisor_, kLeastTolerance, kMostTolerance)});
  }
  return errors;
}

}  // namespace lf
