// SPDX-License-Identifier: Apache-2.0
// A moving camera of an example path: what it begins with, and how it moves.
#pragma once

#include <string>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// A movement makes no sense if LF cameras have not recorded more than this share of a frame.
inline constexpr double kMostUnseen = 0.01;
// Widths that frames may be cropped to, as shares of their width, so that LF cameras have recorded
// them.
inline constexpr double kFrameCrops[] = {1, 0.9, 0.8, 0.7};

struct Shot {
  PinholeCamera start;  // LF camera at which the path starts, or which it passes
  Intrinsics frame;     // of the frames at `start`, before they are cropped
  Vec3 up_world;        // up direction of the frames
  double focus_distance_w = 0;
  double lens_radius_w = 0;
  double spacing_w = 0;  // of the LF cameras
  Reach reach;           // of the LF cameras around `start`

  // Returns the point that a moving camera keeps looking at, and that stays in focus.
  Vec3 SubjectWorld() const {
    return start.CentreWorld() + focus_distance_w * start.ForwardWorld();
  }
};

// How a camera moves that keeps looking at Shot::SubjectWorld().
struct CameraMove {
  std::vector<Vec3> keys_world;  // positions, evenly spaced in time; at least two
  double duration_s = 0;
  double crop = 1;      // width and height of the frames / those of Shot::frame
  std::string limit;    // a sentence that says how far the camera moves, and why no farther
  std::string warning;  // why the film may disappoint; empty if there is nothing to say
};

// Returns by how many elements the movement changes the picture of a frame: the largest
// displacement of very distant objects against the subject, or of the border of the picture.
double VisibleMovement(const Shot& shot, const CameraMove& move);

// Returns the end of CameraMove::limit that tells how far the frames are cropped; empty if they are
// not.
std::string CropWords(double crop);

// Returns how far LF cameras extend beside a camera: for each axis of `camera`, the 95th percentile
// of the distances along this axis to the LF cameras within `radius_w` of it. Unlike
// CaptureReach(), it is flat for the near part of a ring. `camera` must be an LF camera of the
// light field.
Reach ReachNear(const LightField& light_field, const PinholeCamera& camera, double radius_w);

// Returns true if the LF cameras within `radius_w` of a camera stand nearly in a row, as seen by
// it: a lens of this radius blurs along the row alone. False if there are fewer than three.
bool StandInARow(const LightField& light_field, const PinholeCamera& camera, double radius_w);

}  // namespace lf
