// Reads folders of the 4D Light Field Benchmark (HCI, Konstanz): parameters.cfg beside
// input_Cam000.png, input_Cam001.png ... (doc/formats/hci.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr const char* kHciName = "parameters.cfg";

// A grid of parallel cameras, numbered row by row from the upper left, as the benchmark's Blender
// add-on places them. World: x right, y down, z into the scene, in metres, with the middle of the
// grid as origin. With F = focal_length_mm / sensor_size_mm * max(width, height) pixels and the
// focus distance Z0, where the disparity is 0, the camera at (x, y) has its principal point at (w /
// 2 + F x / Z0, h / 2 + F y / Z0); if Z0 = 0, at the image centre. The depth range follows from
// disp_min and disp_max, which are rounded to a tenth of a pixel, if both correspond to finite
// depths.
//   text  the file's content
//   path  its name for messages; its folder becomes LightField::folder
// kInput names the file, the key, the value found and what was expected.
Result<LightField> ParseHci(std::string_view text, const std::filesystem::path& path);

Result<LightField> ReadHci(const std::filesystem::path& path);

// Returns true if the file states a grid of cameras. Other programs also write files of this name.
bool IsHciFile(const std::filesystem::path& path);

}  // namespace lf
