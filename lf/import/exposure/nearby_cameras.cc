// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/nearby_cameras.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

// Least cosine of the angle between the optical axes of compared LF cameras.
constexpr double kLeastCosine = 0.8;
constexpr size_t kMostRings = 9;
constexpr int kViewsPerRing = 6;
constexpr double kInnerRing = 2;   // radius of the innermost ring, in spacings of LF cameras
constexpr double kRingFactor = 2;  // radius of a ring, relative to the next smaller ring
constexpr size_t kNearest = 6;  // number of nearest LF cameras, compared besides those of the rings

}  // namespace

NearbyCameras::NearbyCameras(const LightField& light_field) : field_(light_field) {
  for (const LfCamera& camera : light_field.cameras) {
    const RigidTransform& pose = camera.cam_from_world;
    centres_.push_back(-(pose.rotation.transpose() * pose.translation));
    forwards_.push_back(pose.rotation.row(2).transpose());
  }
  order_.resize(centres_.size());
  axes_.resize(centres_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (!centres_.empty()) least_ = most_ = centres_[0];
  for (const Vec3& centre : centres_) {
    least_ = least_.cwiseMin(centre);
    most_ = most_.cwiseMax(centre);
  }
  Split(0, order_.size());
  spacing_w_ = MedianSpacing(light_field);
}

void NearbyCameras::Split(size_t begin, size_t end) {
  if (end - begin < 2) return;
  Vec3 least = centres_[order_[begin]], most = least;
  for (size_t i = begin; i < end; ++i) {
    least = least.cwiseMin(centres_[order_[i]]);
    most = most.cwiseMax(centres_[order_[i]]);
  }
  Eigen::Index axis = 0;
  (most - least).maxCoeff(&axis);
  const size_t middle = begin + (end - begin) / 2;
  const auto at = [&](size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
    return std::pair(centres_[a][axis], a) < std::pair(centres_[b][axis], b);
  });
  axes_[middle] = static_cast<uint8_t>(axis);
  Split(begin, middle);
  Split(middle + 1, end);
}

// Visits the LF cameras of a range of order_: its root, then the two halves beside the root, first
// the half on the point's side. Skips halves that are farther from the point than `limit`, which a
// visit may lower.
template <typename Visit>
void NearbyCameras::Search(size_t begin, size_t end, const Vec3& point_world, const double& limit,
                           const Visit& visit) const {
  if (begin >= end) return;
  const size_t middle = begin + (end - begin) / 2;
  const uint32_t root = order_[middle];
  visit(root);
  const double beyond = point_world[axes_[middle]] - centres_[root][axes_[middle]];
  const std::pair<size_t, size_t> lower(begin, middle), upper(middle + 1, end);
  const auto& [near, far] = beyond < 0 ? std::pair(lower, upper) : std::pair(upper, lower);
  Search(near.first, near.second, point_world, limit, visit);
  if (std::abs(beyond) <= limit) Search(far.first, far.second, point_world, limit, visit);
}

std::vector<uint32_t> NearbyCameras::Nearest(const Vec3& point_world, size_t count,
                                             LfImageId camera) const {
  std::vector<std::pair<double, uint32_t>> found;  // heap of distance and index, farthest on top
  double limit = std::numeric_limits<double>::infinity();
  Search(0, order_.size(), point_world, limit, [&](uint32_t other) {
    if (other == camera.value || forwards_[other].dot(forwards_[camera.value]) < kLeastCosine)
      return;
    found.emplace_back((centres_[other] - point_world).norm(), other);
    std::push_heap(found.begin(), found.end());
    if (found.size() > count) {
      std::pop_heap(found.begin(), found.end());
      found.pop_back();
    }
    if (found.size() == count) limit = found.front().first;
  });
  std::sort_heap(found.begin(), found.end());
  std::vector<uint32_t> others;
  for (const auto& [distance_w, other] : found) others.push_back(other);
  return others;
}

View NearbyCameras::ViewOf(const PinholeCamera& camera, uint32_t other) const {
  const Vec3 offset = centres_[other] - camera.CentreWorld();
  return {LfImageId{other}, RayThrough(field_.Camera(LfImageId{other}), camera.ForwardWorld()),
          Vec2(camera.RightWorld().dot(offset), camera.UpWorld().dot(offset)).norm()};
}

// Returns the views nearest to evenly spread positions on a ring around `camera`.
//   turn         rotates the positions, in units of the step between two positions
//   least_share  views must be at least this share of the radius away, and at most twice the
//                radius; 0: views may be at any distance
std::vector<View> NearbyCameras::Ring(LfImageId camera, double radius_w, double turn,
                                      double least_share) const {
  const PinholeCamera middle = field_.Camera(camera);
  std::vector<View> views;
  for (int i = 0; i < kViewsPerRing; ++i) {
    const double angle = 2 * kPi * (i + turn) / kViewsPerRing;
    const Vec3 wanted = middle.CentreWorld() + radius_w * (std::cos(angle) * middle.RightWorld() +
                                                           std::sin(angle) * middle.UpWorld());
    const std::vector<uint32_t> nearest = Nearest(wanted, 1, camera);
    if (nearest.empty()) break;
    View view = ViewOf(middle, nearest[0]);
    const double away = radius_w > 0 ? view.offset_w / radius_w : 0;
    if (view.offset_w <= 0 || (least_share > 0 && (away < least_share || away > 2))) continue;
    const bool is_there = std::any_of(views.begin(), views.end(),
                                      [&](const View& other) { return other.id == view.id; });
    if (!is_there) views.push_back(std::move(view));
  }
  return views;
}

Rings NearbyCameras::DepthRings(LfImageId camera) const {
  const Vec3& centre = centres_[camera.value];
  const double reach_w = (centre - least_).cwiseMax(most_ - centre).norm();
  Rings rings;
  double radius_w = kInnerRing * spacing_w_;
  for (size_t ring = 0; ring < kMostRings && (ring == 0 || radius_w <= 1.2 * reach_w);
       ++ring, radius_w *= kRingFactor) {
    std::vector<View> views =
        Ring(camera, radius_w, 0.5 * static_cast<double>(ring % 2), ring > 0 ? 0.5 : 0);
    if (ring == 0 || views.size() >= kLeastViewsOfRing) rings.push_back(std::move(views));
  }
  return rings;
}

std::vector<View> NearbyCameras::ComparedViews(LfImageId camera, const Rings& rings) const {
  std::vector<View> compared;
  const auto add = [&](const View& view) {
    const bool is_there = std::any_of(compared.begin(), compared.end(),
                                      [&](const View& other) { return other.id == view.id; });
    if (!is_there) compared.push_back(view);
  };
  for (const std::vector<View>& ring : rings)
    for (const View& view : ring) add(view);
  const PinholeCamera middle = field_.Camera(camera);
  for (const uint32_t other : Nearest(centres_[camera.value], kNearest, camera))
    add(ViewOf(middle, other));
  return compared;
}

}  // namespace lf
