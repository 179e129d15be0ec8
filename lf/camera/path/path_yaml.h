// SPDX-License-Identifier: Apache-2.0
// Reads the camera path file (doc/formats/path.md). No other folder uses yaml-cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/path/evaluate_path.h"
#include "lf/camera/transmission.h"
#include "lf/core/result.h"

namespace lf {

// Reads the picture file that lens.transmission names.
//   file  the name as the path states it
using ReadTransmission = std::function<Result<Transmission>(const std::string& file)>;

// Reads the camera path from a text, or from a file.
//
// text                content of the file
// name                name of the file in messages: "path.yaml:12:5: ..."
// light_field_unit_m  metres per world unit of the light field; a path that states another unit is
//                     an error. nullopt if there is no light field: the unit that the path states
//                     is used, or 1 m if it states none.
// read_transmission   empty: a path that names a picture file is an error
// Returns the cameras of all frames. Every key is checked; kInput if anything is wrong. The message
// states file:line:column and the value found; for an unknown key, it lists the allowed keys and
// suggests the nearest one.
Result<CameraPath> ParsePathYaml(std::string_view text, std::string_view name,
                                 std::optional<double> light_field_unit_m,
                                 const ReadTransmission& read_transmission = {});
// Returns the path with its cameras not yet computed. kInput for anything that is wrong whatever
// the frame; PathFrames::Check() finds the errors of single frames.
Result<PathFrames> ParsePathFrames(std::string_view text, std::string_view name,
                                   std::optional<double> light_field_unit_m,
                                   const ReadTransmission& read_transmission = {});
Result<PathFrames> ReadPathFrames(const std::filesystem::path& path,
                                  std::optional<double> light_field_unit_m,
                                  const ReadTransmission& read_transmission = {});
Result<CameraPath> ReadPathYaml(const std::filesystem::path& path,
                                std::optional<double> light_field_unit_m,
                                const ReadTransmission& read_transmission = {});

}  // namespace lf
