// SPDX-License-Identifier: Apache-2.0
// Finds the image files of a light field if their paths or sizes differ from the calibration,
// because the photographs were moved, renamed or downscaled after they were calibrated.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns true if a folder of this name holds something other than photographs: masks, depths or
// normals.
bool NamesSomethingElse(const std::string& folder_name);

// Returns true if at least one of up to 64 evenly spread LF images has a file at the path that its
// name states.
bool HasSomeImageFiles(const LightField& light_field);

// Searches for image files if HasSomeImageFiles() is false, or if `images_folder` is given and is
// not light_field->folder. All formats search by this function.
//
// Without `images_folder`, files are searched first where the ends of the names lead, in
// light_field->folder and the two folders above it: "..\\images\\1.jpg" and "C:\\a\\images\\1.jpg"
// are found as images/1.jpg. Otherwise, a file fits an LF image if both have the same base name.
// Extension, upper and lower case, folders, and the normal form of Unicode (NFC or NFD) may differ,
// as may a date before one of the names, if no file has the name itself (folded_name.h). If several
// files fit, the best is the one whose path shares most trailing folders with the name; then the
// one with most pixels (each folder is judged by its first image); then the one nested in the
// fewest folders. A file in a folder for something other than photographs (masks, depth, normals)
// fits only if the LF image's name contains such a folder. A file fits a mask only if it also lies
// in a folder with the name of the mask's folder.
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

// Returns true if an image of this [width, height] may be a copy of an image of the calibrated size
// that was made smaller by a whole factor from 1 to 16, as ImageScale says.
bool IsWholeFraction(const Intrinsics& calibrated, const std::array<int, 2>& size);

// Scales the intrinsics to the size of the files. Returns the size of the files divided by the
// calibrated size; 1 if nothing changed. Lens distortion is defined on directions and needs no
// change. kInput for kFactor, unless the factor is 1: a file does not have `factor` times the
// calibrated size.
Result<double> FitToImageFiles(const ImageScale& scale, LightField* light_field);

}  // namespace lf
