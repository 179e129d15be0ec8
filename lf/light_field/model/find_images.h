// Finds the image files of a light field whose place or size differs from its calibration:
// photographs that were moved, renamed or downscaled after they were calibrated.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Searches for image files if none of up to 64 LF images, evenly spread, is where its name says, or
// if `images_folder` is given and the names lead elsewhere. A file fits an LF image if both have
// the same base name; suffix, upper and lower case and folders may differ. If several files fit,
// the best one is the one whose path shares most trailing folders with the name; then the one with
// most pixels; then the one in fewest folders. Files in folders for something else than photographs
// (masks, depth, normals) fit only names with such a folder. A mask must share its folder with its
// name.
//
// Returns how many LF images got another name, and logs it if there are two or more LF images. The
// new names are relative to the folder; LF images without a file keep theirs. No pixels are read.
//   images_folder  searched with its subfolders, instead of light_field->folder
// kInput: several files fit an LF image equally well.
Result<size_t> FindImageFiles(const std::optional<std::filesystem::path>& images_folder,
                              LightField* light_field);

// How the size of image files may differ from the calibration.
struct ImageScale {
  // kOff: sizes must be equal. kAuto: files may be smaller by one whole factor from 2 to 16,
  // rounded up, down or to the nearest pixel as COLMAP and nerfstudio do, if all of some evenly
  // spread LF images are. kFactor: files are `factor` times as large, rounded in one of these ways.
  enum class Kind { kOff, kAuto, kFactor } kind = Kind::kAuto;
  double factor = 1;
};

// Reads "auto", "off", or a factor above 0 such as 0.25. kUsage for any other text.
Result<ImageScale> ParseImageScale(const std::string& text);

// Scales the intrinsics to the size of the files. Returns the factor, which is 1 if nothing
// changed. Lens distortion is defined on directions and needs no change.
// kInput for kFactor: a file has another size.
Result<double> FitToImageFiles(const ImageScale& scale, LightField* light_field);

}  // namespace lf
