// SPDX-License-Identifier: Apache-2.0
// Chooses the size of the orbit of an example path, so that LF cameras have recorded what its
// frames show. Internal to example_path.cc.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct OrbitWish {
  PinholeCamera start;          // LF camera at which the orbit begins
  Intrinsics frame;             // largest frame at the start
  Vec3 up_world;                // up direction of the frames
  double focus_distance_w = 0;  // the camera keeps looking at the point ahead of `start` there
  double lens_radius_w = 0;
  double spacing_w = 0;          // of the LF cameras
  double right_w = 0, up_w = 0;  // semi-axes of the largest ellipse that the positions would allow
};

struct Orbit {
  double scale = 1;  // of both semi-axes
  double crop = 1;   // width and height of the frames / those of OrbitWish::frame
  // Share of the elements of the worst frame that no LF camera near the lens has recorded, 0 to 1,
  // in this orbit, and in the largest one with frames of full size.
  double unseen = 0;
  double unseen_of_largest = 0;
};

// The number of keys of an orbit after the first.
inline constexpr int kOrbitKeys = 8;

// Returns the place of the camera at the share `turn` of an orbit, 0 to 1: an ellipse from the
// start to the left and back.
Vec3 OrbitPosition(const OrbitWish& wish, double scale, double turn);

// Returns the orbit with the largest scale times crop of those that are tried, of whose frames LF
// cameras have recorded at least 99 %. If there is none, the orbit of which they have recorded
// most. An element counts as recorded if an LF camera sees its point on the focus plane through the
// lens, or through a lens as wide as two spacings of LF cameras, if that is wider.
Orbit ChooseOrbit(const LightField& light_field, const OrbitWish& wish);

}  // namespace lf
