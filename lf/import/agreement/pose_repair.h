// SPDX-License-Identifier: Apache-2.0
// Usual mistakes in the poses, intrinsics and names of a capture, and what undoes them: matrices
// the wrong way round, axes of another convention, mirrored images, focal lengths in other units,
// names shifted by one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// How the matrices [R | t] of LfCamera::cam_from_world were really meant. c is the recorded camera
// centre, D = diag(1, -1, -1) converts between axes of OpenGL and ours.
enum class PoseReading : uint8_t {
  kAsRecorded,
  kInverse,            // [R | t]^-1: world to camera was written for camera to world
  kTranspose,          // R^T with the centre c
  kTransposeOpenGl,    // D R^T D with the centre c
  kTransposeRotation,  // [R^T | t]
  kCentre,             // R with the centre t: the centre was written for the translation
  kTranslation,        // [R | c]: the translation was written for the centre
};

// To which pose an image belongs, in the natural order of the names (1, 2, 10).
enum class NameOrder : uint8_t {
  kAsRecorded,
  kNext,      // each image has the pose recorded for the next name
  kPrevious,  // each image has the pose recorded for the name before it
  kReversed,
  kFromText,  // images sorted as text (1, 10, 2) got the poses of images sorted by number
  kToText,    // the other way round
};

// Axes of a frame of reference, each an axis of another one: 1, 2, 3 are x, y, z, negative if it
// points the other way.
using Axes = std::array<int, 3>;
inline constexpr Axes kSameAxes = {1, 2, 3};

struct Repair {
  PoseReading reading = PoseReading::kAsRecorded;
  Axes camera_axes = kSameAxes;    // right, down and forward in terms of the recorded camera axes
  Axes position_axes = kSameAxes;  // axes of the positions alone, without the rotations
  bool mirror_x = false, mirror_y = false;       // images are mirrored left to right, upside down
  bool swap_principal_point = false;             // cx and cy are exchanged
  std::array<double, 2> focal_factors = {1, 1};  // by which fx and fy are multiplied
  NameOrder names = NameOrder::kAsRecorded;

  bool is_none() const { return *this == Repair{}; }
  friend bool operator==(const Repair&, const Repair&) = default;
};

// Parses words separated by commas, as NameOf() returns them. kUsage for other words.
Result<Repair> ParseRepair(std::string_view text);
// Returns the words of the repair, for --repair: "inverse,axes:x-y-z". Empty if there is none.
std::string NameOf(const Repair& repair);
// Returns the fault that the repair undoes, as a clause: "the matrices were inverted".
std::string ClauseOf(const Repair& repair);

// Returns the camera that an image has after a repair, NameOrder aside. A mirrored image keeps its
// pixels: the world is mirrored with it, so that rays and pixels belong together.
//   is_rectified  IsRectified() of the light field: principal points then move with
//                 Repair::position_axes
PinholeCamera RepairedCamera(const Repair& repair, PinholeCamera camera, bool is_rectified);

// Returns true if principal points move with the positions of the cameras, as in rectified slabs.
bool IsRectified(const LightField& light_field);

// Returns the indices of names sorted so that numbers in them count by their value: 2 before 10.
std::vector<uint32_t> NaturalOrder(const std::vector<std::string>& names);

// Returns, for each image, the index of the camera that it belongs to; UINT32_MAX for none.
std::vector<uint32_t> CamerasOfImages(NameOrder order, const std::vector<std::string>& names);

// Applies a repair to all LF cameras. LF images that NameOrder leaves without a pose are removed.
// Returns their number.
size_t ApplyRepair(const Repair& repair, LightField* light_field);

// Returns the repairs that are tried, the most usual mistakes first; those of focal lengths are not
// among them.
//   are_parallel  true: the cameras look in parallel directions, as in a grid, in which axes of the
//                 grid are more often mistaken than axes of the cameras
std::vector<Repair> UsualRepairs(bool are_parallel);

}  // namespace lf
