// SPDX-License-Identifier: Apache-2.0
// Inflates a zlib stream, and verifies its end and its checksum. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lf {

// Inflates one stream after another, in the same memory.
class ZlibBlock {
 public:
  // Inflates the whole stream and verifies its checksum. The first `size` bytes become stored(); up
  // to `size` + 1 MiB more are allowed, because some programs fill up the last strip of a picture.
  // Returns null if the stream is valid, otherwise what is wrong with it. Throws std::bad_alloc if
  // memory runs out.
  const char* Inflate(std::span<const std::byte> stream, size_t size);

  // The bytes that the last Inflate() kept, as a zlib stream without compression.
  std::span<uint8_t> stored() { return stored_; }

 private:
  std::vector<uint8_t> stored_;
};

}  // namespace lf
