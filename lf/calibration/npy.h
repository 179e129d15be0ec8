// Arrays of numbers as NumPy stores them (.npy). Internal to calibration.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct NpyArray {
  std::vector<size_t> shape;
  std::vector<double> values;  // in C order: the last index runs fastest
};

// The bytes of a .npy file of format 1 or 2 that holds little-endian floats of 4 or 8 bytes
// ('<f4', '<f8') in C order, of 1 to 4 dimensions, none of them 0.
// kInput, without the place: anything else, named; a length that differs from the shape's.
Result<NpyArray> ParseNpy(std::string_view bytes);

}  // namespace lf
