// SPDX-License-Identifier: Apache-2.0
// A file in memory, for tests of readers of image files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "lf/pixels/files/image_probe.h"

namespace lf {

// Returns a source that reads from `bytes`, which must outlive it.
inline ByteSource SourceOf(const std::string& bytes) {
  return [&bytes](uint64_t offset, std::span<uint8_t> to) -> size_t {
    if (offset >= bytes.size()) return 0;
    const size_t count = std::min<uint64_t>(to.size(), bytes.size() - offset);
    std::copy_n(bytes.data() + offset, count, to.data());
    return count;
  };
}

}  // namespace lf
