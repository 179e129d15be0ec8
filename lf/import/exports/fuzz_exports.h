// SPDX-License-Identifier: Apache-2.0
// Checks that the fuzz targets of the readers of exports share.
#pragma once

#include <array>
#include <string>

#include "lf/core/check.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Checks that an error names a file in the folder f/.
inline void CheckFault(const Error& error) { LF_CHECK(error.message.starts_with("f/")); }

// Checks what a reader made of any bytes: an error that names a file in the folder f/, or cameras
// of which FinishExport() makes a valid light field or such an error.
inline void CheckExport(const Result<ExportedCameras>& parsed) {
  if (!parsed) return CheckFault(parsed.error());
  const ExportOptions options = {.image_size = [](const std::filesystem::path&) {
    return Result(std::array{640, 480});
  }};
  ExportedCameras cameras = *parsed;
  cameras.folder = "f/none";
  const Result<LightField> light_field = FinishExport(std::move(cameras), "f/export", options);
  if (!light_field) {
    LF_CHECK(light_field.error().message.starts_with("f/export: "));
    return;
  }
  LF_CHECK(light_field->size() > 0);
  LF_CHECK(light_field->image_names.size() == light_field->size());
  for (const LfCamera& camera : light_field->cameras) {
    const Mat3& rotation = camera.cam_from_world.rotation;
    LF_CHECK((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9);
    LF_CHECK(rotation.determinant() > 0);
    LF_CHECK(camera.cam_from_world.translation.allFinite());
    const Intrinsics& k = light_field->intrinsics[camera.intrinsics_index];
    LF_CHECK(k.fx_px > 0 && k.fy_px > 0 && k.width_px > 0 && k.height_px > 0);
    LF_CHECK(IsDistortion(k.distortion));
  }
}

}  // namespace lf
