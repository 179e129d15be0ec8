// SPDX-License-Identifier: Apache-2.0
// Parses file names that state the position of a camera (doc/formats/stanford.md):
//
//   [NAME_]ROW_COL.ext, [NAME_]rROW_cCOL.ext, [NAME-]ROW-COL.ext, [NAME](ROW,COL).ext
//   [NAME_]ROW_COL_Y_X.ext                       positions in millimetres
//   [NAME_]ROW_COL_Y_X_FOCALMM_SENSORMM.ext
//   input_CamNNN.ext                             number of a camera of the 4D Light Field Benchmark
#pragma once

#include <optional>
#include <string_view>

namespace lf {

struct StanfordName {
  int row = 0;
  int column = 0;
  struct Position {
    double y_mm = 0;
    double x_mm = 0;
  };
  std::optional<Position> position;
  struct Lens {
    double focal_mm = 0;
    double sensor_width_mm = 0;  // above 0, as is focal_mm
  };
  std::optional<Lens> lens;  // lens of the camera; set only if `position` is set
};

// Returns the values in a file name; nullopt if the name has another form. NAME may contain blanks
// and underscores; ROW and COL are digits, the other fields decimal numbers without exponent. If
// NAME itself ends in numbers, the fitting form with the most fields is used. The letters r and c
// may also be row and col, and be upper case; the '_' between rROW and cCOL may be '-' or missing.
// A '_' before the extension is skipped, because names in the Stanford Light Field Archive end in
// it.
std::optional<StanfordName> ParseStanfordName(std::string_view file_name);

// Returns NNN of the name input_CamNNN.ext, under which the 4D Light Field Benchmark numbers the
// cameras of a grid row by row; nullopt for other names.
std::optional<int> NumberOfHciName(std::string_view file_name);

}  // namespace lf
