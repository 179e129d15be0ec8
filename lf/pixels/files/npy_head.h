// SPDX-License-Identifier: Apache-2.0
// Parses the heads of NumPy's files of arrays (.npy).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct NpyHead {
  std::string descr;           // type of the numbers, such as "<f4" or "|u1"
  bool fortran_order = false;  // true: the first index runs fastest
  std::vector<size_t> shape;   // at most kMostNpyDimensions sizes
  size_t values_begin = 0;     // offset of the numbers in the file
};

inline constexpr size_t kMostNpyDimensions = 5;
// The head lies within this number of bytes.
inline constexpr size_t kMostNpyHeadBytes = 65536 + 16;

// Parses the head of a .npy file of format 1 or 2, from the first bytes of the file. kInput for any
// other content, which the message states. The message does not name the file; the caller adds it.
Result<NpyHead> ParseNpyHead(std::string_view bytes);

// Returns text from a file in the form in which messages show it: at most 80 characters, with ? for
// each character that is not printable ASCII.
std::string ShownNpyText(std::string_view text);

// Returns the number of values of a shape. The message of kInput, if it is 0 or above 2^32, does
// not name the file.
Result<size_t> NpyValueCount(const std::vector<size_t>& shape);

}  // namespace lf
