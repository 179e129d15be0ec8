// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/camera_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "lf/core/median.h"
#include "lf/densify/natural_neighbours.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

// Returns true if the camera sees a point, or would in an image twice as large. Lens
// distortion is ignored.
//   point  homogeneous, in camera axes
bool Sees(const Intrinsics& k, const Vec3& point) {
  constexpr double kBeyond = 0.5;  // share of the size, on each side
  if (!(point.z() > 0)) return false;
  const double y = point.y() / point.z(), x = point.x() / point.z();
  const double u = k.fx_px * x + k.skew_px * y + k.cx_px, v = k.fy_px * y + k.cy_px;
  return u >= -kBeyond * k.width_px && u <= (1 + kBeyond) * k.width_px &&
         v >= -kBeyond * k.height_px && v <= (1 + kBeyond) * k.height_px;
}

// Returns the number of the direction, of eight, of an offset.
int DirectionOf(const Vec2& offset) {
  const double turn = std::atan2(offset.y(), offset.x()) / kPi * 4;
  return static_cast<int>(std::floor(turn + 8.5)) % 8;
}

// Returns the LF cameras that one of them is compared with.
//   chart  around it
//   usual    distance between LF cameras
//   most     largest distance of LF cameras on the chart, except for the nearest two
std::vector<uint32_t> NearestAllAround(const CameraChart& chart, uint32_t id, double usual,
                                       double most) {
  constexpr size_t kLeast = 4, kAlways = 2;
  constexpr double kFarthest = 4, kSamePosition = 1e-6;
  std::vector<uint32_t> order = ByDistance(chart.points, Vec2::Zero());
  std::erase_if(order, [&](uint32_t at) {
    return chart.ids[at] == id || chart.points[at].norm() <= kSamePosition * usual;
  });
  std::vector<uint32_t> chosen;
  if (order.empty()) return chosen;
  const double nearest = chart.points[order[0]].norm();
  const double farthest = std::min(kFarthest * std::max(usual, nearest), most);
  bool has[8] = {};
  for (const uint32_t at : order) {
    if (chart.points[at].norm() > farthest && chosen.size() >= kAlways) break;
    bool& is_taken = has[DirectionOf(chart.points[at])];
    if (!is_taken) chosen.push_back(chart.ids[at]);
    is_taken = true;
  }
  for (const uint32_t at : order) {
    const bool is_far = chart.points[at].norm() > most && chosen.size() >= kAlways;
    if (chosen.size() >= kLeast || is_far) break;
    if (std::find(chosen.begin(), chosen.end(), chart.ids[at]) == chosen.end())
      chosen.push_back(chart.ids[at]);
  }
  return chosen;
}

// Returns the two LF cameras that are nearest to one, but not at its position.
std::vector<uint32_t> NearestTwo(const LightField& light_field, std::span<const uint32_t> among,
                                 uint32_t id) {
  const Vec3 centre = light_field.Camera(LfImageId{id}).CentreWorld();
  std::vector<std::pair<double, uint32_t>> order;
  for (const uint32_t other : among) {
    const double distance = (light_field.Camera(LfImageId{other}).CentreWorld() - centre).norm();
    if (distance > 0) order.emplace_back(distance, other);
  }
  std::sort(order.begin(), order.end());
  std::vector<uint32_t> nearest;
  for (size_t k = 0; k < std::min<size_t>(2, order.size()); ++k) nearest.push_back(order[k].second);
  return nearest;
}

}  // namespace

std::vector<uint32_t> FarEnoughApart(const LightField& light_field,
                                     const std::optional<Vec3>& subject) {
  const double most_cosine = std::cos(RadiansFromDegrees(kLeastApart_deg));
  std::vector<uint32_t> ids;
  std::vector<Vec3> directions;  // [ids]: from the subject
  for (uint32_t id = 0; id < light_field.size(); ++id) {
    if (subject) {
      const Vec3 direction =
          (light_field.Camera(LfImageId{id}).CentreWorld() - *subject).normalized();
      if (std::any_of(directions.begin(), directions.end(),
                      [&](const Vec3& other) { return direction.dot(other) > most_cosine; }))
        continue;
      directions.push_back(direction);
    }
    ids.push_back(id);
  }
  return ids;
}

CameraChart ChartAround(const LightField& light_field, std::span<const uint32_t> among,
                        const PinholeCamera& camera, double inverse_distance) {
  const double most = std::tan(RadiansFromDegrees(kMostAside_deg));
  const Ray ray = CentralRay(camera);
  const Vec3 along = camera.cam_from_world.rotation * ray.direction;
  const Vec3 direction = along / along.z();
  CameraChart chart;
  for (const uint32_t id : among) {
    const PinholeCamera other = light_field.Camera(LfImageId{id});
    const Vec3 other_centre = other.CentreWorld();
    const Vec3 centre = camera.cam_from_world * other_centre;
    const double before = 1 - inverse_distance * centre.z();
    if (!(before > 0)) continue;
    const Vec2 point = (centre.head<2>() - centre.z() * direction.head<2>()) / before;
    if (!(inverse_distance * point.norm() <= most)) continue;
    // The point looked at in axes of the other camera, times its inverse distance.
    const Vec3 looked_at =
        other.cam_from_world.rotation *
        (ray.direction / along.z() + inverse_distance * (ray.origin - other_centre));
    if (!Sees(other.intrinsics, looked_at)) continue;
    chart.ids.push_back(id);
    chart.points.push_back(point);
  }
  return chart;
}

double InverseDistanceOf(const PinholeCamera& camera, const std::optional<Vec3>& subject) {
  if (!subject) return 0;
  const double distance = (camera.cam_from_world * *subject).z();
  return distance > 0 ? 1 / distance : 0;
}

std::vector<std::vector<uint32_t>> CompareWith(const LightField& light_field,
                                               std::span<const uint32_t> among,
                                               const std::optional<Vec3>& subject) {
  constexpr size_t kUsual = 3;  // the distance to the third nearest LF camera is the usual one
  constexpr double kMostTurned_deg = 22;  // as seen from the subject
  const auto inverse_distance_of = [&](uint32_t id) {
    return InverseDistanceOf(light_field.Camera(LfImageId{id}), subject);
  };
  const auto chart_of = [&](uint32_t id) {
    return ChartAround(light_field, among, light_field.Camera(LfImageId{id}),
                       inverse_distance_of(id));
  };
  std::vector<double> usual;
  for (const uint32_t id : among) {
    std::vector<double> distances;
    for (const Vec2& point : chart_of(id).points) distances.push_back(point.norm());
    if (distances.empty()) continue;
    std::sort(distances.begin(), distances.end());
    usual.push_back(distances[std::min(kUsual, distances.size() - 1)]);
  }
  const double median = usual.empty() ? 0 : Median(std::move(usual));
  std::vector<std::vector<uint32_t>> result;
  for (uint32_t id = 0; id < light_field.size(); ++id) {
    const double inverse_distance = inverse_distance_of(id);
    const double most = inverse_distance > 0
                            ? std::tan(RadiansFromDegrees(kMostTurned_deg)) / inverse_distance
                            : std::numeric_limits<double>::infinity();
    result.push_back(NearestAllAround(chart_of(id), id, median, most));
    if (result.back().empty()) result.back() = NearestTwo(light_field, among, id);
  }
  return result;
}

}  // namespace lf
