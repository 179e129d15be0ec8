// SPDX-License-Identifier: Apache-2.0
// Light fields and shots for tests of moves.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "lf/camera/pinhole.h"
#include "lf/focus/moves/example_frame.h"
#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns a light field of `count` LF images, 0000.png and on. Image i is recorded at position(i)
// by a camera that looks at target(i), with the y axis of the world downwards.
inline LightField TrackOf(uint32_t count, const std::function<Vec3(uint32_t)>& position,
                          const std::function<Vec3(uint32_t)>& target) {
  LightField field;
  field.intrinsics.push_back({100, 100, 50, 40, 0, 100, 80});
  for (uint32_t i = 0; i < count; ++i) {
    LfCamera camera;
    camera.cam_from_world = *LookAlong(position(i), target(i) - position(i), -Vec3::UnitY());
    field.cameras.push_back(camera);
    const std::string number = std::to_string(i);
    field.image_names.push_back("images/" + std::string(4 - number.size(), '0') + number + ".png");
  }
  return field;
}

// Returns the track of a hand that walks around the origin on a circle of radius 1, half a degree
// from one image to the next, and shakes by up to `shake_w` in each direction.
inline LightField HandHeld(uint32_t count, double shake_w) {
  return TrackOf(
      count,
      [=](uint32_t i) {
        const double angle = RadiansFromDegrees(0.5) * (i - count / 2.0);
        const Vec3 shake(std::sin(71.0 * i), std::sin(53.0 * i), std::sin(97.0 * i));
        return Vec3(Vec3(std::sin(angle), 0, -std::cos(angle)) + shake_w * shake);
      },
      [](uint32_t) { return Vec3(Vec3::Zero()); });
}

// Returns a grid of parallel cameras, a world unit apart, whose numbers run along its rows; every
// other row runs backwards if `is_serpentine` is true.
inline LightField NumberedGrid(uint32_t side, bool is_serpentine) {
  const auto position = [=](uint32_t i) {
    const uint32_t row = i / side, column = i % side;
    const bool is_back = is_serpentine && row % 2 == 1;
    return Vec3(is_back ? side - 1 - column : column, row, 0);
  };
  return TrackOf(side * side, position,
                 [=](uint32_t i) { return Vec3(position(i) + Vec3(0, 0, 100)); });
}

// Returns the shot that begins at an LF camera.
inline Shot ShotAt(const LightField& field, LfImageId id, double focus_distance_w,
                   double lens_radius_w) {
  Shot shot;
  shot.start = field.Camera(id);
  shot.up_world = LevelUpWorld(field, shot.start);
  shot.frame = InscribedFrame(shot.start, shot.up_world);
  shot.focus_distance_w = focus_distance_w;
  shot.spacing_w = MedianSpacing(field);
  shot.lens_radius_w = lens_radius_w;
  shot.reach = CaptureReach(field, shot.start, 400);
  return shot;
}

inline double LengthOf(const CameraMove& move) {
  double length_w = 0;
  for (size_t i = 1; i < move.keys_world.size(); ++i)
    length_w += (move.keys_world[i] - move.keys_world[i - 1]).norm();
  return length_w;
}

}  // namespace lf
