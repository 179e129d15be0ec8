// Reads arrays of numbers in NumPy's format (.npy). Internal to this folder.
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

// Parses a .npy file of format 1 or 2 with little-endian floats of 4 or 8 bytes ('<f4', '<f8') in C
// order and 1 to 4 dimensions, none of them 0.
// kInput, without the file's name: any other content, named in the message; data whose length does
// not match the shape.
Result<NpyArray> ParseNpy(std::string_view bytes);

}  // namespace lf
