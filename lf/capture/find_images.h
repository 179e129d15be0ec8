// Finds the image files of a light field that are not where, or not as large as, its calibration
// says: photographs that were moved, renamed or made smaller after they were calibrated.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

// Looks for image files if none of up to 64 LF images, evenly spread, is where its name says, or if
// `images_folder` is given and is not where the names lead. A file fits an LF image if both have
// the same base name, whatever the suffix, its case, and the folders. Of several files that fit,
// the one wins whose path has most trailing folders in common with the name; then the one with more
// pixels; then the one in fewer folders. Files in folders that hold something else than photographs
// (masks, depth, normals) fit only names with such a folder. Masks must have their folder in
// common, too.
//
// Returns how many LF images have other names now, and logs it for two or more LF images. These
// names are relative to the folder; LF images without a file keep theirs. No pixels are read.
//   images_folder  the only folder to look in, with those below it; else light_field->folder
// kInput: several files fit an LF image equally well.
Result<size_t> FindImageFiles(const std::optional<std::filesystem::path>& images_folder,
                              LightField* light_field);

// How image files may differ in size from the calibration.
struct ImageScale {
  // kOff: not at all. kAuto: if all of some LF images, evenly spread, are smaller by one whole
  // factor from 2 to 16, rounded up, down or to the nearest pixel, as COLMAP and nerfstudio do.
  // kFactor: `factor` times as large, rounded in one of these ways.
  enum class Kind { kOff, kAuto, kFactor } kind = Kind::kAuto;
  double factor = 1;
};

// Reads "auto", "off", or a factor above 0 such as 0.25. kUsage.
Result<ImageScale> ParseImageScale(const std::string& text);

// Scales the intrinsics to the files that are there. Returns the factor; 1 if nothing changed. Lens
// distortion is of directions and needs no change.
// kInput with kFactor: a file has another size.
Result<double> FitToImageFiles(const ImageScale& scale, LightField* light_field);

}  // namespace lf
