// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/orbit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "lf/focus/moves/move_coverage.h"

namespace lf {
namespace {

constexpr int kOrbitKeys = 8;  // after the first
// A calm film is no wider and no faster than this, as seen from the subject.
constexpr double kMostOrbit_rad = RadiansFromDegrees(8);
constexpr double kOrbitPerSecond_rad = RadiansFromDegrees(6);
constexpr double kLeastOrbit_s = 49 / 25.0, kMostOrbit_s = 4;

struct Orbit {
  // Place of the middle of the ellipse. 0: at the LF camera; -1, 1: to the left, to the right of
  // it, so that the LF camera is at the end of an ellipse half as large.
  double side = 0;
  double scale = 1;  // of both semi-axes
  double crop = 1;   // as CameraMove::crop
  // Share of the elements of the worst frame that no LF camera near the lens has recorded, 0 to 1.
  double unseen = 0;

  double size() const { return side == 0 ? scale : scale / 2; }
};

class OrbitSearch {
 public:
  OrbitSearch(const LightField& light_field, const Shot& shot)
      : shot_(shot),
        coverage_(CoverageNear(light_field, shot, kMostOrbit_rad * shot.focus_distance_w)),
        right_w_(SemiAxis(shot.reach.right_w)),
        up_w_(SemiAxis(shot.reach.up_w)) {}

  double WidthOf(const Orbit& orbit) const { return 2 * orbit.size() * right_w_; }
  double HeightOf(const Orbit& orbit) const { return 2 * orbit.size() * up_w_; }

  // Returns the place of the camera at the share `turn` of an orbit, 0 to 1.
  Vec3 Position(const Orbit& orbit, double turn) const {
    // The ellipse begins at the LF camera, or on its left.
    const double angle = 2 * kPi * turn, begin = orbit.side == 0 ? -1 : -orbit.side;
    const double right_w = WidthOf(orbit) / 2, up_w = HeightOf(orbit) / 2;
    return shot_.start.CentreWorld() +
           right_w * (begin * std::cos(angle) + orbit.side) * shot_.start.RightWorld() +
           up_w * std::sin(angle) * shot_.start.UpWorld();
  }

  Orbit Largest() const { return Measured({0, 1, 1, 0}); }

  // Returns the best orbit: the largest if LF cameras have recorded its frames.
  Orbit Choose() const {
    constexpr double kScales[] = {1, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05};
    Orbit best = Largest();
    if (best.unseen <= kMostUnseen) return best;
    for (const double side : {0.0, -1.0, 1.0})
      for (const double scale : kScales)
        for (const double crop : kFrameCrops) {
          const bool is_good = best.unseen <= kMostUnseen;
          const Orbit wish{side, scale, crop, 0};
          if (is_good && wish.size() * crop <= best.size() * best.crop) continue;
          const Orbit orbit = Measured(wish);
          if (is_good ? orbit.unseen <= kMostUnseen : orbit.unseen < best.unseen) best = orbit;
        }
    return best;
  }

 private:
  double SemiAxis(double reach_w) const {
    return std::clamp(reach_w - shot_.lens_radius_w, 0.0,
                      kMostOrbit_rad * shot_.focus_distance_w / 2);
  }

  Orbit Measured(Orbit orbit) const {
    constexpr int kPositions = 2 * kOrbitKeys;
    for (int i = 0; i < kPositions; ++i)
      orbit.unseen = std::max(
          orbit.unseen, coverage_.Unseen(Position(orbit, i / double{kPositions}), orbit.crop));
    return orbit;
  }

  const Shot& shot_;
  MoveCoverage coverage_;
  double right_w_, up_w_;  // the semi-axes of the largest ellipse
};

// Tells how large the orbit is, and what keeps it from being larger.
std::string LimitOf(const Shot& shot, const OrbitSearch& search, const Orbit& orbit) {
  const double width_w = search.WidthOf(orbit), height_w = search.HeightOf(orbit);
  const std::string size = fmt::format(
      "the orbit is {:.3g} wide and {:.3g} high in world units, {:.2g} degrees as seen from the "
      "subject",
      width_w, height_w,
      DegreesFromRadians(2 * std::atan(std::max(width_w, height_w) / 2 / shot.focus_distance_w)));
  const bool is_calm = std::max(shot.reach.right_w, shot.reach.up_w) - shot.lens_radius_w >
                       kMostOrbit_rad * shot.focus_distance_w / 2;
  std::string limit;
  if (orbit.size() < 1)
    limit = fmt::format(
        ", {:.0f} % of what {} would allow: LF cameras have not recorded {:.0f} % of a frame of a "
        "larger one",
        100 * orbit.size(), is_calm ? "a calm film" : "the positions of the LF cameras",
        100 * search.Largest().unseen);
  else if (is_calm)
    limit = ": a calm film goes no farther";
  else
    limit = fmt::format(
        ": in a larger one the lens, {:.3g} wide, would reach beyond the LF cameras, which extend "
        "{:.3g} to the sides and {:.3g} up and down",
        2 * shot.lens_radius_w, shot.reach.right_w, shot.reach.up_w);
  return size + limit + CropWords(orbit.crop);
}

}  // namespace

CameraMove MakeOrbit(const LightField& light_field, const Shot& shot) {
  const OrbitSearch search(light_field, shot);
  const Orbit orbit = search.Choose();
  CameraMove move;
  for (int i = 0; i <= kOrbitKeys; ++i)
    move.keys_world.push_back(search.Position(orbit, i / double{kOrbitKeys}));
  double length_w = 0;
  for (size_t i = 1; i < move.keys_world.size(); ++i)
    length_w += (move.keys_world[i] - move.keys_world[i - 1]).norm();
  move.duration_s = std::clamp(length_w / shot.focus_distance_w / kOrbitPerSecond_rad,
                               kLeastOrbit_s, kMostOrbit_s);
  move.crop = orbit.crop;
  move.limit = LimitOf(shot, search, orbit);
  if (orbit.unseen > kMostUnseen)
    move.warning = fmt::format(
        "even in this orbit LF cameras have not recorded {:.0f} % of a frame, which will be "
        "black: begin at an LF camera that has neighbours on all sides ({{camera}}), or let the "
        "camera stand ({{move focus-pull}})",
        100 * orbit.unseen);
  return move;
}

}  // namespace lf
