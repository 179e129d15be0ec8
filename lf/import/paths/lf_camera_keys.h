// SPDX-License-Identifier: Apache-2.0
// The lf_* keys of JSON paths: the exact camera and its lens, for which the formats of others have
// no place. Internal to this folder.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/light_field/transforms_json/json_fields.h"
#include "lf/light_field/transforms_json/json_text.h"

namespace lf {

inline constexpr const char* kLfIntrinsicsKey = "lf_intrinsics";
// The keys of a frame (doc/formats/foreign_paths.md).
inline constexpr const char* kLfCameraKeys[] = {
    "lf_cam_from_world",    kLfIntrinsicsKey,    "lf_sensor_width", "lf_focal_length",
    "lf_aperture_diameter", "lf_focus_distance", "lf_blades",       "lf_blade_rotation_rad",
    "lf_blade_roundness",   "lf_aperture_ratio", "lf_hood",         "lf_focus_tilt_rad"};

// Sets the members of a camera that the keys of its frame state. All keys may be missing.
//   camera  has the pose and the intrinsics that the other keys of the frame state
// kInput: a value of a wrong type or out of range; lf_cam_from_world or lf_intrinsics that deviate
// by more than 1e-6 from the camera, because the other keys were changed afterwards.
Result<void> ReadLfCameraKeys(const JsonFields& frame, ForeignCamera* camera);

// Appends `, "lf_cam_from_world": [...], ...`. ReadLfCameraKeys() then returns the same bits.
void AddLfCameraKeys(const RenderCamera& camera, JsonText* out);

}  // namespace lf
