// SPDX-License-Identifier: Apache-2.0
// Reads folders of the 4D Light Field Benchmark (HCI, Konstanz): parameters.cfg beside
// input_Cam000.png, input_Cam001.png ... (doc/formats/hci.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr const char* kHciName = "parameters.cfg";

// Returns a grid of parallel cameras, numbered row by row from the upper left, as the benchmark's
// Blender add-on places them. World: x right, y down, z into the scene, in metres; the origin is
// the middle of the grid. The focal length is F = focal_length_mm / sensor_size_mm * max(w, h), for
// images of w x h pixels. Z0 is the focus distance, at which the disparity is 0: the principal
// point of the camera at (x, y) is (w / 2 + F x / Z0, h / 2 + F y / Z0), or the image centre if Z0
// = 0. The depth range is computed from disp_min - 0.05 and disp_max + 0.05, because the file has
// disparities rounded to a tenth of a pixel; it is not set if one of the two keys is missing or
// corresponds to no finite depth.
//   text  the file's content
//   path  the file's path for messages; its folder becomes LightField::folder
// kInput names the file, the key, the value found and what was expected.
Result<LightField> ParseHci(std::string_view text, const std::filesystem::path& path);

// kInput if the file is larger than 1 MiB.
Result<LightField> ReadHci(const std::filesystem::path& path);

// Returns true if the file has at most 1 MiB and states a grid of cameras (num_cams_x). Other
// programs also write files of this name.
bool IsHciFile(const std::filesystem::path& path);

}  // namespace lf
