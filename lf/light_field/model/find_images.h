// SPDX-License-Identifier: Apache-2.0
// Finds the image files of a light field if their paths or sizes differ from the calibration,
// because the photographs were moved, renamed or downscaled after they were calibrated.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Searches for image files if none of up to 64 evenly spread LF images has a file at the path that
// its name states, or if `images_folder` is given and is not light_field->folder.
//
// A file fits an LF image if both have the same base name; extension, upper and lower case and
// folders may differ. If several files fit, the best is the one whose path shares most trailing
// folders with the name; then the one with most pixels (each folder is judged by its first image);
// then the one nested in the fewest folders. A file in a folder for something other than
// photographs (masks, depth, normals) fits only if the LF image's name contains such a folder. A
// file fits a mask only if it also lies in a folder with the name of the mask's folder.
//
// Changes the names to paths relative to the searched folder, which becomes light_field->folder. LF
// images without a file keep their names. Returns the number of LF images with a file, and logs it
// if the light field has two or more LF images. Returns 0 and changes nothing if nothing is
// searched or found. No pixels are read.
//   images_folder  folder to search, with the subfolders up to three levels below it, except
//                  hidden ones; if it is not given, light_field->folder is searched
// kInput: several files fit an LF image equally well.
Result<size_t> FindImageFiles(const std::optional<std::filesystem::path>& images_folder,
                              LightField* light_field);

// How much the size of image files may differ from the calibration.
struct ImageScale {
  // kOff: the sizes are neither compared nor changed. kAuto: files may be smaller by a whole factor
  // from 2 to 16, with sizes rounded up, down or to the nearest pixel as COLMAP and nerfstudio do.
  // Up to 64 evenly spread LF images are examined; unless all of them have the same factor, nothing
  // is scaled. kFactor: files have `factor` times the calibrated width and height, rounded in one
  // of these ways.
  enum class Kind { kOff, kAuto, kFactor } kind = Kind::kAuto;
  double factor = 1;
};

// Reads "auto", "off", or a factor above 0 and up to 100, such as 0.25. kUsage for any other text.
Result<ImageScale> ParseImageScale(const std::string& text);

// Scales the intrinsics to the size of the files. Returns the size of the files divided by the
// calibrated size; 1 if nothing changed. Lens distortion is defined on directions and needs no
// change. kInput for kFactor, unless the factor is 1: a file does not have `factor` times the
// calibrated size.
Result<double> FitToImageFiles(const ImageScale& scale, LightField* light_field);

}  // namespace lf
