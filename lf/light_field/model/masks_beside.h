// SPDX-License-Identifier: Apache-2.0
// Finds the masks of LF images by their names, for calibrations that do not name masks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the masks of all LF images in a folder, in the form of LightField::mask_names: empty if
// there is none. The mask of the LF image a/b/1.jpg is the first of these files in the folder that
// exists: a/b/1.jpg.png (as COLMAP names masks), a/b/1.png, a/b/1.jpg; the same in b; the same in
// the folder itself, unless another LF image has the base name 1.jpg or 1.*, too.
//   masks_folder  relative to light_field.folder, or absolute; begins the names in the result
std::vector<std::string> MasksIn(const std::filesystem::path& masks_folder,
                                 const LightField& light_field);

// Returns the folders that hold masks of LF images, MasksIn(), and have "mask" in their names:
// those in light_field.folder, beside the first LF image, and beside its folder. Absolute paths,
// sorted.
std::vector<std::filesystem::path> FoldersOfMasks(const LightField& light_field);

// Returns the number of LF images a/1.jpg with a file a/dynamic_mask_1.png beside them. These are
// masks of instant-ngp: white where pixels are to be left out.
size_t CountDynamicMasks(const LightField& light_field);

}  // namespace lf
