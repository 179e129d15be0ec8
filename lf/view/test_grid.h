// SPDX-License-Identifier: Apache-2.0
// A grid of LF cameras and a frame in its middle, for tests.
#pragma once

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/light_field/model/light_field.h"

namespace lf::testing {

// Returns 21 x 21 parallel LF cameras, 5 mm apart, that look along z.
inline LightField GridField() {
  LightField field;
  field.intrinsics = {{70, 70, 32, 24, 0, 64, 48}};
  for (int i = 0; i < 441; ++i) {
    LfCamera camera;
    camera.cam_from_world =
        *LookAlong({0.005 * (i % 21 - 10), 0.005 * (i / 21 - 10), 0}, {0, 0, 1}, {0, -1, 0});
    field.cameras.push_back(camera);
    field.image_names.push_back(std::to_string(i));
  }
  return field;
}

// Returns a render camera in the middle of the grid's plane.
inline RenderCamera GridFrame(int blades = 0) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {80, 80, 40, 30, 0, 80, 60};
  frame.pinhole.cam_from_world = *LookAlong({0, 0, 0}, {0, 0, 1}, {0, -1, 0});
  frame.aperture = {0.0301, blades, 0};
  frame.focus_distance_w = 1;
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {});
  return frame;
}

}  // namespace lf::testing
