// SPDX-License-Identifier: Apache-2.0
// Writes lossless JPEG (ITU T.81, process 14), as it is used in DNG files, for tests.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "lf/core/image.h"

namespace lf {

// Returns the bytes for an image of an even width. Even and odd columns are two components, as DNG
// writers do for mosaics. Each value is predicted from the value to its left in its component, at
// the beginning of a row from the value above.
inline std::string LosslessJpeg(const Image<uint16_t>& image) {
  std::string code;
  const auto append = [&code](std::initializer_list<int> bytes) {
    for (const int byte : bytes) code += static_cast<char>(byte);
  };
  const int width = image.width() / 2, height = image.height();
  append({0xff, 0xd8});
  // Huffman table 0: the 17 classes of differences have codes of 5 bits, equal to the class
  // numbers.
  append({0xff, 0xc4, 0, 19 + 17, 0, 0, 0, 0, 0, 17, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  for (int size = 0; size <= 16; ++size) append({size});
  append({0xff, 0xc3, 0, 14, 16, height >> 8, height & 255, width >> 8, width & 255, 2});
  append({0, 0x11, 0, 1, 0x11, 0});
  append({0xff, 0xda, 0, 10, 2, 0, 0, 1, 0, 1, 0, 0});

  uint64_t bits = 0;
  int bit_count = 0;
  const auto put = [&](uint32_t value, int count) {
    bits = bits << count | value;
    for (bit_count += count; bit_count >= 8; bit_count -= 8) {
      const int byte = static_cast<int>(bits >> (bit_count - 8) & 255);
      append({byte});
      if (byte == 255) append({0});
    }
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * width; ++x) {
      const int before = x >= 2 ? image.at(x - 2, y) : y >= 1 ? image.at(x, y - 1) : 32768;
      const int difference = static_cast<int16_t>(image.at(x, y) - before);
      const int size = std::bit_width(static_cast<unsigned>(std::abs(difference)));
      put(static_cast<uint32_t>(size), 5);
      const int stored = difference < 0 ? difference - 1 : difference;
      if (size < 16) put(static_cast<uint32_t>(stored) & ((1u << size) - 1), size);
    }
  if (bit_count > 0) put((1u << (8 - bit_count)) - 1, 8 - bit_count);
  append({0xff, 0xd9});
  return code;
}

}  // namespace lf
