// Poses of Airborne Optical Sectioning (JKU Linz; doc/formats/aos.md), a JSON file:
//
//   {"images": [{"imagefile": "a.png", "M3x4": [[r11, r12, r13, t1], [...], [...]]}, ...]}
//
// M3x4 is cam_from_world with axes x right, y down, z forward; its numbers may be strings. The
// field of view of the cameras and the folder of the images are not in the file.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

struct AosOptions {
  // Of the whole image, across its width and its height alike: AOS renders images as squares.
  // kInput without it.
  std::optional<double> fov_deg = {};
  // Where the image files are; if not given: the folder of the JSON file, images/ in it, images/
  // and images_ldr/ beside it; the first in which the first image exists.
  std::optional<std::filesystem::path> images_folder = {};
};

// Whether the file is one of these, by its first MiB. False too if it cannot be read.
bool IsAosFile(const std::filesystem::path& path);

// The image size is that of the first image, for all. Where the first image exists with the
// extension .png instead of .tif or .tiff, all such names are taken so, as AOS's programs do.
// Images that are not square get a warning. kInput names the file and the image, the value found
// and what was expected; kUsage for a fov_deg outside 0.01 to 179.
Result<LightField> ReadAos(const std::filesystem::path& path, const AosOptions& options);

// The poses and names alone, without intrinsics; `path` for messages and LightField::folder.
Result<LightField> ParseAosPoses(std::string_view text, const std::filesystem::path& path);

}  // namespace lf
