// SPDX-License-Identifier: Apache-2.0
// Reads poses of Airborne Optical Sectioning (JKU Linz; doc/formats/aos.md), a JSON file:
//
//   {"images": [{"imagefile": "a.png", "M3x4": [[r11, r12, r13, t1], [...], [...]]}, ...]}
//
// M3x4 is cam_from_world with axes x right, y down, z forward; its numbers may be strings. The file
// contains neither the cameras' field of view nor the folder of the images.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct AosOptions {
  // Field of view across both the width and the height of the image, because AOS renders square
  // images. kInput if it is missing.
  std::optional<double> fov_deg = {};
  // Folder of the image files. Unset: the first of these folders that contains the first image: the
  // folder of the JSON file; images/ in it; images/ or images_ldr/ in its parent folder. If none of
  // them does, images are searched by FindImageFiles() (light_field/model/find_images.h).
  std::optional<std::filesystem::path> images_folder = {};
};

// Returns true if the first MiB of the file contains the key "M3x4"; false if the file cannot be
// read.
bool IsAosFile(const std::filesystem::path& path);

// Reads the poses; all images get the size of the first one. If the first image does not exist
// under its name, but with the extension .png instead of .tif or .tiff, all such names are changed,
// as AOS's programs do. Warns if the first image is not square.
// kInput names the file and the image, the value found and what was expected; kUsage for a fov_deg
// outside 0.01 to 179.
Result<LightField> ReadAos(const std::filesystem::path& path, const AosOptions& options);

// Reads only poses and image names, no intrinsics, from the text of a file. `path` is needed only
// for messages and LightField::folder.
Result<LightField> ParseAosPoses(std::string_view text, const std::filesystem::path& path);

}  // namespace lf
