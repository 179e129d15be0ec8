// File names that tell where a camera stood (doc/formats/stanford.md):
//
//   NAME_ROW_COL.ext
//   NAME_ROW_COL_Y_X.ext                         positions in millimetres
//   NAME_ROW_COL_Y_X_FOCALMM_SENSORMM.ext
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
    double sensor_width_mm = 0;  // both above 0
  };
  std::optional<Lens> lens;  // only with a position
};

// None where the file name is of another form. NAME may hold blanks and underscores; ROW and COL
// are digits, the others decimal numbers without exponent. Where NAME ends in numbers too, the
// longest form that fits is taken. A '_' before the extension is skipped, as the archive has it.
std::optional<StanfordName> ParseStanfordName(std::string_view file_name);

}  // namespace lf
