// SPDX-License-Identifier: Apache-2.0
// A grid of LF cameras and a frame in its middle, for tests of the gaps of a lens.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/light_field/model/light_field.h"

namespace lf::testing {

// Returns `rows` rows of 12 parallel LF cameras, 0.01 apart, in the plane z = 0, which is the lens
// plane of Frame() by default.
inline LightField Grid(int rows = 12) {
  LightField field;
  field.intrinsics = {{70, 70, 32, 24, 0, 64, 48}};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < 12; ++x) {
      LfCamera camera;
      camera.cam_from_world =
          *LookAlong({0.01 * (x - 5.5), 0.01 * (y - 0.5 * (rows - 1)), 0}, {0, 0, 1}, {0, -1, 0});
      field.cameras.push_back(camera);
      field.image_names.push_back("image");
    }
  return field;
}

inline RenderCamera Frame(double radius_w, double x = 0, double z = 0, double y = 0) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {160, 160, 40, 30, 0, 80, 60};
  frame.pinhole.cam_from_world = *LookAlong({x, y, z}, {0, 0, 1}, {0, -1, 0});
  frame.aperture = {radius_w, 0, 0};
  frame.focus_distance_w = 1;
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {});
  return frame;
}

}  // namespace lf::testing
