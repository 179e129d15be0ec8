// SPDX-License-Identifier: Apache-2.0
// Checks that every camera of a path is one that can be rendered. For fuzz targets.
#pragma once

#include <cmath>

#include "lf/camera/path/camera_path.h"
#include "lf/core/check.h"

namespace lf {

inline void CheckCameras(const CameraPath& path) {
  LF_CHECK(path.frame_count() > 0 && path.fps > 0 && path.unit_m > 0);
  for (const RenderCamera& camera : path.cameras) {
    const Mat3& rotation = camera.pinhole.cam_from_world.rotation;
    LF_CHECK((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9);
    LF_CHECK(rotation.determinant() > 0);
    LF_CHECK(camera.pinhole.cam_from_world.translation.allFinite());
    const Intrinsics& k = camera.pinhole.intrinsics;
    LF_CHECK(k.InverseMatrix().allFinite() && k.fx_px > 0 && k.fy_px > 0);
    LF_CHECK(k.width_px > 0 && k.height_px > 0);
    LF_CHECK(camera.aperture.radius_w >= 0 && std::isfinite(camera.aperture.radius_w));
    LF_CHECK(std::isfinite(camera.aperture.rotation_rad));
    LF_CHECK(camera.focal_length_w > 0 && camera.sensor_width_w > 0);
    LF_CHECK(camera.focus_distance_w > 0);
    LF_CHECK(camera.focus_plane.normal.allFinite() && std::isfinite(camera.focus_plane.offset_w));
  }
}

}  // namespace lf
