// SPDX-License-Identifier: Apache-2.0
// Facts about the camera of one frame, as a photographer states them: named numbers, which
// lfcammvminfo prints.
#pragma once

#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"

namespace lf {

struct CameraFact {
  std::string name;                // "position_w"; ends in the unit, if any: _w, _mm, _deg, _s
  std::vector<std::string> parts;  // names of the values: "x", "y", "z"; empty for one value
  std::vector<double> values;
};

// Returns these facts, in this order for every camera:
//   frame, time_s
//   position_w         x y z
//   forward, up        x y z of the axes, length 1
//   focal_length_mm    independent of the focus distance
//   field_of_view_deg  horizontal, vertical; at the focus distance of this frame
//   aperture_diameter_mm, f_number (thesis Eq. 2.11; infinite for a pinhole)
//   blades, blade_rotation_deg
//   focus_distance_w   along the optical axis
//   focus_tilt_deg     horizontal, vertical
//   depth_of_field_w   near, far: the depths along the optical axis between which the blur stays
//                      within one element of the plate; far may be infinite
//   shift_mm           horizontal, vertical (ShiftOf())
//   ratio, blade_roundness
//   hood_mm            distance, diameter; 0 if there is no hood
//   transmission       mean of the transmission's places, from 0 to 1; 1 if there is none
std::vector<CameraFact> CameraFacts(const RenderCamera& camera, FrameId frame);

}  // namespace lf
