// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/along.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "lf/focus/moves/move_coverage.h"

namespace lf {
namespace {

constexpr double kMostTravel_rad = RadiansFromDegrees(12);
constexpr double kTravelPerSecond_rad = RadiansFromDegrees(3);
constexpr double kLeastDuration_s = 49 / 25.0;
constexpr int kAlongKeys = 8;  // after the first

enum class Stop { kCalm, kEnd, kTurn, kUnseen };

// The part of a track along which the camera moves.
struct Part {
  double first_w = 0, last_w = 0;  // places along the track
  double travel_rad = 0;
  double crop = 1;
  Stop stops[2] = {Stop::kCalm, Stop::kCalm};  // the obstacles before first_w and behind last_w
};

class AlongSearch {
 public:
  AlongSearch(const LightField& light_field, const RecordedTrack& track, const Shot& shot)
      : track_(track),
        shot_(shot),
        subject_world_(shot.SubjectWorld()),
        smooth_(track, SigmaOf(track, shot)),
        step_w_(std::min(track.neighbour_w / 2, kMostTravel_rad * shot.focus_distance_w / 32)),
        coverage_(light_field, CamerasNearby(), shot, BesideWidth()) {}

  // Returns the part with the largest crop times length.
  Part Choose() const {
    Part best;
    best.crop = 0;
    for (const double crop : kFrameCrops) {
      const Part part = Grown(crop);
      if (best.crop == 0 || part.travel_rad * crop > best.travel_rad * best.crop) best = part;
    }
    return best;
  }

  // Returns positions that divide the part into steps of equal length.
  std::vector<Vec3> Keys(const Part& part) const {
    constexpr int kSamples = 512;
    std::vector<Vec3> points;
    std::vector<double> lengths_w = {0};
    for (int i = 0; i <= kSamples; ++i) {
      const double share = i / double{kSamples};
      points.push_back(
          smooth_.At(part.first_w + share * (part.last_w - part.first_w)).position_world);
      if (i > 0) lengths_w.push_back(lengths_w.back() + (points[i] - points[i - 1]).norm());
    }
    std::vector<Vec3> keys;
    for (int key = 0; key <= kAlongKeys; ++key) {
      const double length_w = lengths_w.back() * key / kAlongKeys;
      const auto next = std::lower_bound(lengths_w.begin(), lengths_w.end(), length_w);
      keys.push_back(points[static_cast<size_t>(
          std::min<std::ptrdiff_t>(next - lengths_w.begin(), kSamples))]);
    }
    return keys;
  }

 private:
  static double SigmaOf(const RecordedTrack& track, const Shot& shot) {
    constexpr double kOfFocus = 0.04, kLeastSteps = 1.5, kMostOfTrack = 1 / 8.0;
    return std::max(
        kLeastSteps * track.neighbour_w,
        std::min(kOfFocus * shot.focus_distance_w, kMostOfTrack * track.places_w.back()));
  }

  // Returns the LF cameras of the track that may see a frame: those within reach of the longest
  // movement, evenly chosen if there are too many.
  std::vector<LfImageId> CamerasNearby() const {
    const Vec3 start = shot_.start.CentreWorld();
    const double reach_w =
        kMostTravel_rad * shot_.focus_distance_w + 2 * shot_.lens_radius_w + 4 * track_.neighbour_w;
    std::vector<LfImageId> near;
    for (size_t i = 0; i < track_.images.size(); ++i)
      if ((track_.positions_world[i] - start).norm() <= reach_w) near.push_back(track_.images[i]);
    const size_t stride = (near.size() + kMostCoverageCameras - 1) / kMostCoverageCameras;
    std::vector<LfImageId> chosen;
    for (size_t i = 0; i < near.size(); i += stride) chosen.push_back(near[i]);
    return chosen;
  }

  // Returns the radius within which LF cameras count: that of the lens, the distance to the next LF
  // camera, or the distance at which the smoothed track passes beside LF cameras, if that is more.
  double BesideWidth() const {
    double beside_w = std::max(shot_.lens_radius_w, track_.neighbour_w);
    const double near_w = kMostTravel_rad * shot_.focus_distance_w;
    for (size_t i = 0; i < track_.images.size(); ++i) {
      if (std::abs(track_.places_w[i] - track_.places_w[track_.at]) > near_w) continue;
      const Vec3 beside = smooth_.At(track_.places_w[i]).position_world - track_.positions_world[i];
      beside_w = std::max(beside_w, beside.norm());
    }
    return beside_w;
  }

  // Returns the part for frames that are cropped by this share.
  Part Grown(double crop) const {
    const double start_w = track_.places_w[track_.at];
    const SmoothTrack::Point start = smooth_.At(start_w);
    Part part{start_w, start_w, 0, crop, {Stop::kUnseen, Stop::kUnseen}};
    if (coverage_.Unseen(start.position_world, crop) > kMostUnseen) return part;
    Vec3 ends[2] = {start.position_world, start.position_world};
    bool is_open[2] = {true, true};
    for (int side = 0; is_open[0] || is_open[1]; side = 1 - side) {
      if (!is_open[side]) continue;
      double& end_w = side == 0 ? part.first_w : part.last_w;
      const double place_w = end_w + (side == 0 ? -step_w_ : step_w_);
      const SmoothTrack::Point point = smooth_.At(place_w);
      const double travel_rad = (point.position_world - ends[side]).norm() /
                                (subject_world_ - (point.position_world + ends[side]) / 2).norm();
      const std::optional<Stop> stop = part.travel_rad + travel_rad > kMostTravel_rad
                                           ? Stop::kCalm
                                           : WhyStop(place_w, point, start, crop);
      if (stop) {
        part.stops[side] = *stop;
        is_open[side] = false;
        continue;
      }
      part.travel_rad += travel_rad;
      end_w = place_w;
      ends[side] = point.position_world;
    }
    return part;
  }

  std::optional<Stop> WhyStop(double place_w, const SmoothTrack::Point& point,
                              const SmoothTrack::Point& start, double crop) const {
    constexpr double kLeastCosine = 0.7;
    if (place_w - shot_.lens_radius_w < 0 || place_w + shot_.lens_radius_w > track_.places_w.back())
      return Stop::kEnd;
    if (point.direction_world.dot(start.direction_world) < kLeastCosine) return Stop::kTurn;
    if (coverage_.Unseen(point.position_world, crop) > kMostUnseen) return Stop::kUnseen;
    return std::nullopt;
  }

  const RecordedTrack& track_;
  const Shot& shot_;
  Vec3 subject_world_;
  SmoothTrack smooth_;
  double step_w_;
  MoveCoverage coverage_;
};

std::string WhyNoFarther(const Part& part) {
  const auto has = [&](Stop stop) { return part.stops[0] == stop || part.stops[1] == stop; };
  if (has(Stop::kCalm)) return "a calm film goes no farther";
  std::string why;
  const auto add = [&](Stop stop, const char* reason) {
    if (has(stop)) why += fmt::format("{}{}", why.empty() ? "" : ", and ", reason);
  };
  add(Stop::kEnd, "beyond, the lens would reach past the end of the track");
  add(Stop::kTurn, "beyond, the track turns");
  add(Stop::kUnseen, "beyond, the LF images do not show what surrounds the subject");
  return why;
}

}  // namespace

CameraMove MakeAlong(const LightField& light_field, const RecordedTrack& track, const Shot& shot) {
  const AlongSearch search(light_field, track, shot);
  const Part part = search.Choose();
  CameraMove move;
  move.keys_world = search.Keys(part);
  move.duration_s = std::max(kLeastDuration_s, part.travel_rad / kTravelPerSecond_rad);
  move.crop = part.crop;
  double length_w = 0;
  for (size_t i = 1; i < move.keys_world.size(); ++i)
    length_w += (move.keys_world[i] - move.keys_world[i - 1]).norm();
  const auto nearest = [&](double place_w) {
    const auto at = std::min_element(
        track.places_w.begin(), track.places_w.end(),
        [&](double a, double b) { return std::abs(a - place_w) < std::abs(b - place_w); });
    const LfImageId id = track.images[static_cast<size_t>(at - track.places_w.begin())];
    return light_field.image_names[id.value];
  };
  const std::string first = nearest(part.first_w), last = nearest(part.last_w);
  move.limit = fmt::format(
      "the camera moves {:.3g} in world units along the recorded track, smoothed, {}, {:.2g} "
      "degrees as seen from the subject: {}{}",
      length_w, first == last ? "around " + first : fmt::format("from {} to {}", first, last),
      DegreesFromRadians(part.travel_rad), WhyNoFarther(part), CropWords(part.crop));
  return move;
}

}  // namespace lf
