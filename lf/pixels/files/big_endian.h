// Reads the numbers of JPEG and PNG files. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "lf/pixels/files/file_bytes.h"

namespace lf {

// Returns `count` bytes at `offset` as a number, the most significant first; none if they lie
// beyond the end.
inline std::optional<uint64_t> BigEndian(const ByteSource& source, uint64_t offset, size_t count) {
  std::array<uint8_t, 8> bytes;
  if (source(offset, std::span(bytes).first(count)) != count) return std::nullopt;
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace lf
