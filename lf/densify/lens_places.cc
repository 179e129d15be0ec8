// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/lens_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kRow = 0.86602540378443865;  // distance of the rows of a hexagonal lattice

double LensRadius(const RenderCamera& frame) { return frame.aperture.radius_w; }

// Returns the tangent of the largest angle between the optical axis and a ray of the picture.
double WidestTangent(const Intrinsics& k) {
  const double x = std::max(std::abs(k.cx_px), std::abs(k.width_px - k.cx_px)) / k.fx_px;
  const double y = std::max(std::abs(k.cy_px), std::abs(k.height_px - k.cy_px)) / k.fy_px;
  return std::hypot(x, y);
}

// Returns true if the lens of a frame lies almost in the lens plane of `first`.
bool IsInPlane(const RenderCamera& first, const RenderCamera& frame) {
  constexpr double kMostTurn_deg = 6, kMostBefore = 0.2;  // of the lens's radius
  const double cosine = first.pinhole.ForwardWorld().dot(frame.pinhole.ForwardWorld());
  if (cosine < std::cos(RadiansFromDegrees(kMostTurn_deg))) return false;
  const double before = (first.pinhole.cam_from_world * frame.pinhole.CentreWorld()).z();
  return std::abs(before) * WidestTangent(frame.pinhole.intrinsics) <=
         kMostBefore * std::max(LensRadius(first), LensRadius(frame));
}

// Returns the point of the scene that an element in focus shows, or a far point of its ray.
Vec3 SeenAt(const RenderCamera& frame, double x_px, double y_px) {
  constexpr double kFar = 1000;  // focus distances
  if (const std::optional<Vec3> point = FocusPointOfElement(frame, x_px, y_px)) return *point;
  return RayOfPixel(frame.pinhole, x_px, y_px).At(kFar * frame.focus_distance_w);
}

// The directions in which a camera looks, as x / z and y / z.
struct Directions {
  Vec2 least = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 most = -least;

  void Add(const Vec3& point_camera) {
    constexpr double kMostTangent = 2;
    if (!(point_camera.z() > 0)) return;
    const Vec2 direction = (point_camera.head<2>() / point_camera.z())
                               .cwiseMax(Vec2::Constant(-kMostTangent))
                               .cwiseMin(Vec2::Constant(kMostTangent));
    least = least.cwiseMin(direction);
    most = most.cwiseMax(direction);
  }
};

void AddPicture(const RenderCamera& frame, const RigidTransform& cam_from_world,
                Directions* directions) {
  const PixelRect part = ElementsOf(frame);
  const double x[] = {double(part.x_begin), (part.x_begin + part.x_end) / 2.0, double(part.x_end)};
  const double y[] = {double(part.y_begin), (part.y_begin + part.y_end) / 2.0, double(part.y_end)};
  for (const double u : x)
    for (const double v : y) directions->Add(cam_from_world * SeenAt(frame, u, v));
}

// Returns intrinsics without distortion whose picture holds the directions, with a small margin.
Intrinsics IntrinsicsFor(const Directions& directions, double f_px) {
  constexpr double kMargin_px = 3;
  Intrinsics k;
  k.fx_px = k.fy_px = f_px;
  k.cx_px = kMargin_px - std::floor(f_px * directions.least.x());
  k.cy_px = kMargin_px - std::floor(f_px * directions.least.y());
  k.width_px = static_cast<int>(k.cx_px + std::ceil(f_px * directions.most.x()) + kMargin_px);
  k.height_px = static_cast<int>(k.cy_px + std::ceil(f_px * directions.most.y()) + kMargin_px);
  return k;
}

}  // namespace

std::vector<FilmSection> SectionsOf(std::span<const RenderCamera> frames) {
  LF_CHECK(!frames.empty());
  std::vector<FilmSection> sections;
  for (size_t f = 0; f < frames.size(); ++f) {
    if (f == 0 || !IsInPlane(frames[sections.back().frames.front()], frames[f]))
      sections.emplace_back();
    sections.back().frames.push_back(f);
  }
  for (FilmSection& section : sections) {
    const size_t count = section.frames.size();
    section.camera = frames[section.frames[count / 2]].pinhole;
    for (const size_t f : section.frames)
      section.inverse_focus += 1 / frames[f].focus_distance_w / static_cast<double>(count);
  }
  return sections;
}

FilmLenses::FilmLenses(const LightField& light_field, std::span<const uint32_t> used,
                       std::span<const RenderCamera> frames)
    : light_field_(light_field),
      frames_(frames),
      sections_(SectionsOf(frames)),
      section_of_frame_(frames.size()) {
  for (const RenderCamera& frame : frames) centres_world_.push_back(frame.pinhole.CentreWorld());
  for (size_t s = 0; s < sections_.size(); ++s) {
    for (const size_t f : sections_[s].frames) section_of_frame_[f] = s;
    charts_.push_back(
        ChartAround(light_field, used, sections_[s].camera, sections_[s].inverse_focus));
  }
}

std::vector<uint32_t> FilmLenses::Serving() const {
  std::set<uint32_t> serving;
  for (size_t f = 0; f < frames_.size(); ++f) {
    if (f > 0 && centres_world_[f] == centres_world_[f - 1]) continue;
    const size_t s = section_of_frame_[f];
    const Vec2 centre = (sections_[s].camera.cam_from_world * centres_world_[f]).head<2>();
    const std::vector<uint32_t> order = ByDistance(charts_[s].points, centre);
    for (size_t k = 0; k < std::min(kServing, order.size()); ++k)
      serving.insert(charts_[s].ids[order[k]]);
  }
  return {serving.begin(), serving.end()};
}

std::vector<uint32_t> FilmLenses::Recorded(double distance) const {
  std::vector<uint32_t> ids;
  for (uint32_t id = 0; id < light_field_.size(); ++id) {
    const Vec3 centre_world = light_field_.Camera(LfImageId{id}).CentreWorld();
    for (size_t f = 0; f < frames_.size(); ++f) {
      if ((centre_world - centres_world_[f]).norm() > LensRadius(frames_[f]) + distance) continue;
      ids.push_back(id);
      break;
    }
  }
  return ids;
}

size_t FilmLenses::NearestFrame(const Vec3& point_world) const {
  const auto nearest = std::min_element(
      centres_world_.begin(), centres_world_.end(), [&](const Vec3& a, const Vec3& b) {
        return (a - point_world).squaredNorm() < (b - point_world).squaredNorm();
      });
  return static_cast<size_t>(nearest - centres_world_.begin());
}

double FilmLenses::Area_w2() const {
  double area = 0;
  for (size_t f = 0; f < frames_.size(); ++f) {
    const double radius = LensRadius(frames_[f]);
    if (f > 0 && centres_world_[f] == centres_world_[f - 1] && radius == LensRadius(frames_[f - 1]))
      continue;
    area += kPi * radius * radius;
  }
  return area;
}

LensPlaces FilmLenses::Places(double distance, double outside) const {
  LensPlaces result;
  result.filled_radius_w = std::numeric_limits<double>::infinity();
  std::vector<Vec3> recorded_world;
  for (uint32_t id = 0; id < light_field_.size(); ++id)
    recorded_world.push_back(light_field_.Camera(LfImageId{id}).CentreWorld());
  for (size_t s = 0; s < sections_.size(); ++s) {
    const FilmSection& section = sections_[s];
    const CameraChart& chart = charts_[s];
    const RigidTransform world_from_plane = section.camera.cam_from_world.Inverse();
    // Places by row and column of the lattice; none where no virtual LF camera can stand.
    std::map<std::pair<int, int>, std::optional<LatticePlace>> lattice;
    const auto place_of = [&](int row, int column) {
      return Vec2((column + (row % 2 != 0 ? 0.5 : 0.0)) * distance, row * kRow * distance);
    };
    for (const size_t f : section.frames) {
      const Vec2 centre = (section.camera.cam_from_world * centres_world_[f]).head<2>();
      const double radius = LensRadius(frames_[f]), reach = radius + distance;
      const int top = static_cast<int>(std::floor((centre.y() - reach) / (kRow * distance)));
      const int bottom = static_cast<int>(std::ceil((centre.y() + reach) / (kRow * distance)));
      const int left = static_cast<int>(std::floor((centre.x() - reach) / distance)) - 1;
      const int right = static_cast<int>(std::ceil((centre.x() + reach) / distance)) + 1;
      for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column) {
          const Vec2 place = place_of(row, column);
          const double from_middle = (place - centre).norm();
          if (from_middle > reach) continue;
          auto [entry, is_new] = lattice.try_emplace({row, column});
          if (is_new && !chart.points.empty()) {
            const LatticePlace at = PlaceAmong(chart.points, place);
            if ((at.place - at.inside).norm() <= outside + 1e-3 * distance) entry->second = at;
          }
          if (!entry->second && from_middle <= radius)
            result.filled_radius_w = std::min(result.filled_radius_w, from_middle);
        }
    }
    for (auto& [at, place] : lattice) {
      if (!place) continue;
      const Vec3 centre_world = world_from_plane * Vec3(place->place.x(), place->place.y(), 0);
      // Each place belongs to one section, also at the border between two.
      if (section_of_frame_[NearestFrame(centre_world)] != s) continue;
      const bool is_recorded = std::any_of(
          recorded_world.begin(), recorded_world.end(),
          [&](const Vec3& recorded) { return (recorded - centre_world).norm() < distance / 2; });
      if (!is_recorded) result.places.push_back({s, centre_world, *std::move(place)});
    }
  }
  return result;
}

VirtualCamera FilmLenses::CameraAt(const LensPlace& place, double distance, int divisor) const {
  constexpr double kBeside = 2;     // lattice distances beside a lens that use a place
  constexpr double kInside = 1e-6;  // tolerance for rounding, as a share of the distance
  VirtualCamera result;
  result.is_beyond = place.Beyond() > kInside * distance;
  result.sources = place.at.neighbours;
  AddNearest(charts_[place.section].points, place.at.place, &result.sources);
  double f_px = 0;
  for (WeightedPoint& source : result.sources) {
    source.index = charts_[place.section].ids[source.index];
    f_px += source.weight * light_field_.Camera(LfImageId{source.index}).intrinsics.fx_px / divisor;
  }
  const size_t nearest = NearestFrame(place.centre_world);
  const auto away = [&](size_t f) { return (centres_world_[f] - place.centre_world).norm(); };
  const Mat3& rotation = frames_[nearest].pinhole.cam_from_world.rotation;
  result.camera.cam_from_world = {rotation, -(rotation * place.centre_world)};
  Directions directions;
  double element_px = 0;
  for (size_t f = 0; f < frames_.size(); ++f) {
    if (f != nearest && away(f) > LensRadius(frames_[f]) + kBeside * distance) continue;
    AddPicture(frames_[f], result.camera.cam_from_world, &directions);
    element_px = std::max(element_px, frames_[f].pinhole.intrinsics.fx_px);
  }
  result.camera.intrinsics = IntrinsicsFor(directions, std::min(f_px, element_px));
  return result;
}

}  // namespace lf
