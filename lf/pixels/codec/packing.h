// SPDX-License-Identifier: Apache-2.0
// Packs coefficients into bytes that zstd compresses well, compresses these, and reverses both
// steps (doc/formats/lf_image.md, "Streams"). Internal to this folder.
//
// Most coefficients are 0, 1 or -1, and small ones have small neighbours. zstd compresses bytes,
// and spends at least one bit on each; therefore up to four coefficients share a byte. Coefficients
// first become numbers without a sign (Folded()). A number that is too large for its share of the
// byte is an escape: the byte holds the largest value of the share, and the remainder (the number
// minus this value) is appended to a second stream, which is packed in the same way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// How the numbers of a stream are packed. This value is the first byte of the encoded stream.
enum class Packing : uint8_t {
  kZeros = 0,  // all numbers are 0; the stream has no other bytes
  kOne = 1,    // 1 number per byte (kTwo: 2, kFour: 4), the first in the lowest bits
  kTwo = 2,
  kFour = 4,
  kPlanes2 = 18,  // 2 bytes per number (kPlanes3: 3, kPlanes4: 4), without escapes: first the
                  // lowest bytes of all numbers, then the next bytes of all
  kPlanes3 = 19,
  kPlanes4 = 20,
};

// Largest number of nested streams of escapes. Without this limit, a damaged file could make the
// decoder recurse to any depth.
inline constexpr int kMostEscapes = 4;

// Returns a number that has the sign of `value` in its lowest bit: 0, -1, 1, -2, ... become 0, 1,
// 2, 3, ...
template <class T>
uint32_t Folded(T value) {
  return (static_cast<uint32_t>(int32_t{value}) << 1) ^ static_cast<uint32_t>(int32_t{value} >> 31);
}

// Appends the coefficients as a stream, packed in the way that is expected to make it shortest;
// appends nothing if there are none. All values must fit into T.
template <class T>
void AppendCoefficients(std::span<const int32_t> values, std::string* code);

// Reads a stream of `count` coefficients from the front of `code` and removes it there. `values`
// must have room for kSlack more elements (wavelet53.h). Returns false if the stream is damaged.
template <class T>
[[nodiscard]] bool TakeCoefficients(Transform transform, std::string_view* code, size_t count,
                                    T* values);

}  // namespace lf
