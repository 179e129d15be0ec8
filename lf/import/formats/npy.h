// SPDX-License-Identifier: Apache-2.0
// Reads arrays of numbers in NumPy's format (.npy). Internal to this folder.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct NpyArray {
  std::vector<size_t> shape;
  std::vector<double> values;  // numbers in C order: the last index runs fastest
};

// Parses a .npy file of format 1 or 2 with little-endian floats of 4 or 8 bytes ('<f4', '<f8') in C
// order and at most 4 dimensions, each of them 1 or more.
// kInput for any other content, which the message states, and for data whose length does not match
// the shape. The message does not name the file; the caller adds it.
Result<NpyArray> ParseNpy(std::string_view bytes);

}  // namespace lf
