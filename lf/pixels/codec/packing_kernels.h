// SPDX-License-Identifier: Apache-2.0
// The two implementations that unpack the streams of packing.h, for unsigned numbers of 16 and 32
// bits. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lf/pixels/codec/packing.h"

namespace lf {

inline int PerByte(Packing packing) { return static_cast<int>(packing); }
inline bool IsPlanes(Packing packing) { return packing >= Packing::kPlanes2; }
inline int PlaneCount(Packing packing) { return static_cast<int>(packing) - 16; }
// Returns the value that marks an escape in the packings kOne, kTwo and kFour. Smaller values are
// the numbers themselves.
inline uint32_t EscapeOf(Packing packing) { return (1u << (8 / PerByte(packing))) - 1; }

// A stream whose bytes are decompressed and whose escapes are unpacked.
template <class U>
struct PackedStream {
  Packing packing = Packing::kOne;  // never kZeros, because such a stream has no bytes
  std::span<const uint8_t> bytes;   // the packed numbers, followed by kSlack bytes (wavelet53.h)
  size_t count = 0;                 // number of numbers in the stream
  std::span<const U> escapes;       // remainders that are added to the escapes, in order;
                                    // followed by kSlack elements
  bool has_signs = false;           // true if the numbers are results of Folded() (packing.h),
                                    // which unpacking must reverse
};

// Unpacks the numbers of a stream. `numbers` must have room for kSlack more elements. Returns false
// if the stream has more or fewer escapes than remainders.
template <class U>
[[nodiscard]] bool UnpackReference(const PackedStream<U>& stream, U* numbers);
template <class U>
[[nodiscard]] bool UnpackSimd(const PackedStream<U>& stream, U* numbers);

}  // namespace lf
