// Coefficients to bytes that zstd does well with, and back (doc/formats/lf_image.md, "Streams").
// Internal to codec.
//
// Most coefficients are 0, 1 or -1, and small ones have small ones beside them. zstd knows bytes
// alone, and gives each at least one bit; so up to four coefficients share a byte. Those that are
// too large for their place are escapes: what is left of them is a stream of its own, packed in
// turn as makes it short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "lf/codec/wavelet53.h"

namespace lf {

// What a stream is made of: the first byte of its code.
enum class Packing : uint8_t {
  kZeros = 0,  // nothing more follows
  kOne = 1,    // numbers in a byte, the first in the lowest bits
  kTwo = 2,
  kFour = 4,
  kPlanes2 = 18,  // the lowest bytes of all numbers, then the next ones; no escapes
  kPlanes3 = 19,
  kPlanes4 = 20,
};

// Streams of escapes of escapes, at most: what damaged codes may ask for.
inline constexpr int kMostEscapes = 4;

// Signs in the lowest bit: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
template <class T>
uint32_t Folded(T value) {
  return (static_cast<uint32_t>(int32_t{value}) << 1) ^ static_cast<uint32_t>(int32_t{value} >> 31);
}

// Appends a stream of them, packed as makes it short. All must fit into T.
template <class T>
void AppendCoefficients(std::span<const int32_t> values, std::string* code);

// Takes a stream of `count` coefficients from the front of `code`. `values` has slack. False:
// damage.
template <class T>
[[nodiscard]] bool TakeCoefficients(Transform transform, std::string_view* code, size_t count,
                                    T* values);

}  // namespace lf
