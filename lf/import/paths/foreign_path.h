// SPDX-License-Identifier: Apache-2.0
// A camera path as a foreign file states it, before the missing quantities are completed. Internal
// to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/core/result.h"
#include "lf/import/check/similarity.h"
#include "lf/import/paths/open_path.h"
#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {

// The camera of one frame. A length without a value is not stated by the file.
struct ForeignCamera {
  PinholeCamera pinhole;  // without distortion
  std::optional<double> sensor_width_w, focal_length_w, aperture_diameter_w, focus_distance_w;
  int blades = 0;
  double blade_rotation_rad = 0;
  double ratio = 1, roundness = 0;  // as in Aperture
  Hood hood;
  FocusTilt focus_tilt;
};

struct ForeignPath {
  double fps = 30;
  std::optional<double> unit_m;  // metres per world unit
  std::vector<ForeignCamera> cameras;
  int views = 1;                          // of each moment (CameraPath::views)
  uint32_t first_frame = 1;               // CameraPath::first_frame
  std::optional<DepthRange> depth_range;  // depths of the scene, if the file states them
  // The largest field of view that the file states in a unit that is not known;
  // none if it states no field of view, or if another key says the same in a known unit.
  std::optional<double> largest_fov;
  // Phrases of the warning, such as "no frames per second (30 are used; set {fps})".
  std::vector<std::string> lacks;
};

// The default of PathOptions::fps and its like.
inline constexpr double kDefaultFps = 30;
inline constexpr std::array<int, 2> kDefaultResolution_px = {1920, 1080};
inline constexpr double kDefaultSensorWidth_mm = 36;
inline constexpr size_t kMaxPathBytes = size_t{1} << 30;  // largest file of a foreign path

// Returns options.fps, or the default, which it adds to path->lacks.
double FpsOr(const PathOptions& options, ForeignPath* path);
// Returns options.resolution_px, or the default, which it adds to path->lacks.
std::array<int, 2> ResolutionOr(const PathOptions& options, ForeignPath* path);

// Returns the intrinsics of a plate with square elements whose centre is the principal point.
// fov_deg is the vertical field of view, above 0 and below 180.
Intrinsics IntrinsicsOfFov(double fov_deg, const std::array<int, 2>& resolution_px);

// Returns the intrinsics of a lens of options.focal_length_mm on the sensor, for files that state
// no field of view. If the focal length is not given, it is 50 mm, and path->lacks says so.
Intrinsics IntrinsicsOfLens(const PathOptions& options, const std::array<int, 2>& resolution_px,
                            ForeignPath* path);

// Returns the rule for a vertical field of view as a file states it, in degrees or, if
// options.fov_unit says so, in radians.
NumberRule FovRule(const PathOptions& options);

// Returns a field of view that a file states, in degrees. Notes it in path->largest_fov.
double FovDeg(double stated, const PathOptions& options, ForeignPath* path);

// Returns the vertical field of view of a plate in degrees, as IntrinsicsOfFov() takes it.
double VerticalFov_deg(const Intrinsics& k);

// Returns the number of views of each moment, which the key lf_views of the top level states; 1 if
// it is missing. CompletePath() checks that it divides the number of frames.
Result<int> ViewsOfKey(const JsonFields& top);

// Returns the number of the first frame, which the key lf_first_frame of the top level states; 1 if
// it is missing. CompletePath() checks the number of the last frame.
Result<uint32_t> FirstFrameOfKey(const JsonFields& top);

// Moves the camera into world b, its lens included.
void MoveInto(const Similarity& b_from_a, ForeignCamera* camera);

// Completes the cameras. A warning lists the quantities that the file lacks.
//   file  for messages
// kInput: path.unit_m contradicts the light field; all fields of view may be radians, and
// options.fov_unit is not set; a quantity of a frame is out of its range; the
// number of views of a moment does not divide the number of frames; the last frame would have a
// number above kLargestFrameNumber.
Result<CameraPath> CompletePath(ForeignPath&& path, const std::filesystem::path& file,
                                const PathOptions& options);

// Replaces the quantities of every camera that the options state. kInput: a quantity would be out
// of its range. kUsage: both f_number and aperture_diameter_mm are given.
Result<void> ReplaceQuantities(const PathOptions& options, const std::filesystem::path& file,
                               CameraPath* path);

}  // namespace lf
