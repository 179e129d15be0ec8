// SPDX-License-Identifier: Apache-2.0
// The camera path as its file describes it, checked as far as this is possible without evaluating
// single frames. Lengths are world units and angles radians, independent of the file's units.
#pragma once

#include <optional>
#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/path/focal_surface_source.h"
#include "lf/camera/path/motion.h"
#include "lf/camera/path/yaml_schema.h"
#include "lf/camera/transmission.h"
#include "lf/core/geometry.h"

namespace lf {

// A quantity that may change over time.
struct Quantity {
  Motion motion;
  // The members below are used to check the range and in messages.
  std::string label;          // name in messages, such as "lens.focus_distance_mm"
  YamlPlace place;            // position in the file where the motion is stated
  NumberRange range;          // limits of every component, in units of the file
  double units_per_file = 1;  // internal value = units_per_file * value in the file
};

// The times of a light field video that a path shows: `from` at the time 0 of the path, and `speed`
// units of recording time later for each second. Speed 0 stands still.
struct RecordingClock {
  double from = 0;
  double speed = 1;

  double At(double time_s) const { return from + speed * time_s; }
};

struct PathDescription {
  std::string file_name;
  double fps = 30;
  int frame_count = 0;
  int first_frame = 1;  // number of the first frame, which is at time 0
  double unit_m = 1;
  int width_px = 0;
  int height_px = 0;
  int views = 1;  // of each moment (CameraPath::views)
  Shutter shutter;
  std::optional<RecordingClock> recording;  // unset: the path does not move through time

  Quantity position_w;
  std::optional<Quantity> look_at_w;    // set unless `orientation` is set
  std::optional<Quantity> orientation;  // yaw, pitch, roll in radians, or quaternion w, x, y, z
  Vec3 up = -Vec3::UnitY();             // upward direction in the world; used with look_at_w
  // Used with look_at_w: true if the camera keeps its direction of time 0 while it moves.
  bool keep_direction = false;
  Quantity roll_rad;  // applied after look_at_w or orientation

  // Two of the three members below are set; they determine the third quantity. If the file gives
  // only the focal length or only the field of view, the sensor width is 36 mm.
  std::optional<double> sensor_width_w;
  std::optional<Quantity> focal_length_w;
  std::optional<Quantity> field_of_view_rad;  // horizontal, when focused at infinity
  // From the optical axis to the middle of the picture, horizontally (to the right) and vertically
  // (upwards), in world units on a plate that does not turn the picture around.
  Quantity shift_w;

  std::optional<Quantity> aperture_diameter_w;  // set unless `f_number` is set
  std::optional<Quantity> f_number;
  std::optional<Quantity> focus_distance_w;  // set unless `focus_point_w` is set
  std::optional<Quantity> focus_point_w;
  Quantity focus_tilt_rad;  // horizontal and vertical tilt (FocusTilt)
  bool breathing = false;
  int blades = 0;
  Quantity blade_rotation_rad;
  double blade_rotation_per_stop_rad = 0;
  double ratio = 1;      // Aperture::ratio
  double roundness = 0;  // Aperture::roundness
  double hood_distance_w = 0;
  double hood_diameter_w = 0;  // 0: there is no hood
  TransmissionPtr transmission;
  std::optional<FocalSurfaceSource> focal_surface;
};

}  // namespace lf
