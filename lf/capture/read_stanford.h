// Folders whose file names tell where the cameras stood, as in the Stanford Light Field Archive
// (doc/formats/stanford.md):
//
//   NAME_ROW_COL_Y_X[_FOCALMM_SENSORMM].ext      positions in millimetres
//
// The cameras look straight ahead, R = I, from (X, Y, 0) / 1000 in a world with x right, y down,
// z into the scene and metres as units.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

struct StanfordName {
  int row = 0;
  int column = 0;
  double y_mm = 0;
  double x_mm = 0;
  struct Lens {
    double focal_mm = 0;
    double sensor_width_mm = 0;  // both above 0
  };
  std::optional<Lens> lens;
};

// None where the file name is of another form. NAME may hold blanks and underscores; ROW and COL
// are digits, the others decimal numbers without exponent. Where NAME ends in numbers too, the
// long form is taken if it fits. A '_' before the extension is skipped, as the archive has it.
std::optional<StanfordName> ParseStanfordName(std::string_view file_name);

// Whether an image file in the folder has such a name.
bool HoldsStanfordNames(const std::filesystem::path& folder);

// All images with such names, by row and column. The first one's header tells the image size, for
// all; the principal point is the image's centre, the focal length FOCAL / SENSOR * width pixels.
// Other files are left out, with a warning that counts and names them.
//   focal_px  if given, goes before the names
// kInput: no such name, two images with one row and column, names that lack the focal length, or
// some that have it and some that do not, an unreadable first image.
Result<LightField> ReadStanfordFolder(const std::filesystem::path& folder,
                                      std::optional<double> focal_px = std::nullopt);

}  // namespace lf
