// SPDX-License-Identifier: Apache-2.0
// Checks of readers of exports, for fuzz targets and unit tests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/log.h"
#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// Returns 640 x 480 pixels for every image, whether it exists or not.
inline Result<std::array<int, 2>> AnySize(const std::filesystem::path&) {
  return std::array{640, 480};
}

// Checks what a fuzz target was given: the light field of `cameras` must be valid, or the messages
// of errors must begin with the name of the file.
inline void CheckExport(Result<ExportedCameras> cameras, const std::filesystem::path& file) {
  SetLogLevel(LogLevel::kError);
  const auto is_fault = [&](const Error& error) {
    return error.message.starts_with(file.string() + ": ") && error.kind == ErrorKind::kInput;
  };
  if (!cameras) {
    LF_CHECK(is_fault(cameras.error()));
    return;
  }
  ExportOptions options;
  options.image_size = AnySize;
  const Result<LightField> light_field = FinishExport(*std::move(cameras), file, options);
  if (!light_field) {
    LF_CHECK(is_fault(light_field.error()));
    return;
  }
  LF_CHECK(light_field->size() > 0 && light_field->image_names.size() == light_field->size());
  for (uint32_t i = 0; i < light_field->size(); ++i) {
    const PinholeCamera camera = light_field->Camera({i});
    const Mat3& rotation = camera.cam_from_world.rotation;
    LF_CHECK((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9);
    LF_CHECK(rotation.determinant() > 0);
    LF_CHECK(camera.cam_from_world.translation.allFinite());
    LF_CHECK(camera.intrinsics.InverseMatrix().allFinite());
    DistortionMap map(camera.intrinsics.distortion);
    (void)map;
  }
}

}  // namespace lf
