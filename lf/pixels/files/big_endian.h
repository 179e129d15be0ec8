// SPDX-License-Identifier: Apache-2.0
// Reads the numbers of JPEG and PNG files. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "lf/pixels/files/file_bytes.h"

namespace lf {

// Returns the number in the `count` bytes at `offset`, the most significant byte first; none if the
// bytes lie beyond the end of the file. `count` is at most 8.
inline std::optional<uint64_t> BigEndian(const ByteSource& source, uint64_t offset, size_t count) {
  std::array<uint8_t, 8> bytes;
  if (source(offset, std::span(bytes).first(count)) != count) return std::nullopt;
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace lf
