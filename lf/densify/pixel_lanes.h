// SPDX-License-Identifier: Apache-2.0
// The four lanes of a pixel as a vector, which the compiler computes with at once. Internal to this
// folder.
#pragma once

#include <cstdint>
#include <cstring>

namespace lf {

using PixelLanes [[gnu::vector_size(16)]] = float;

inline PixelLanes LanesOf(const uint16_t* pixel) {
  using Stored [[gnu::vector_size(8)]] = uint16_t;
  Stored stored;
  std::memcpy(&stored, pixel, sizeof(stored));
  return __builtin_convertvector(stored, PixelLanes);
}

}  // namespace lf
