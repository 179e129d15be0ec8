// The implementations behind packing.h, for unsigned numbers of 16 and 32 bits. Internal to codec.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lf/codec/packing.h"

namespace lf {

inline int PerByte(Packing packing) { return static_cast<int>(packing); }
inline bool IsPlanes(Packing packing) { return packing >= Packing::kPlanes2; }
inline int PlaneCount(Packing packing) { return static_cast<int>(packing) - 16; }
// What stands for an escape; smaller numbers are as they are.
inline uint32_t EscapeOf(Packing packing) { return (1u << (8 / PerByte(packing))) - 1; }

// A stream, its bytes decompressed and its escapes unpacked.
template <class U>
struct PackedStream {
  Packing packing = Packing::kOne;  // not kZeros
  std::span<const uint8_t> bytes;   // with slack behind
  size_t count = 0;                 // numbers
  std::span<const U> escapes;       // what is to be added to the first one, ...; with slack
  bool has_signs = false;           // in the lowest bit of each number, to be unfolded
};

// Its numbers. `numbers` has slack. False: it has more escapes, or fewer.
template <class U>
[[nodiscard]] bool UnpackReference(const PackedStream<U>& stream, U* numbers);
template <class U>
[[nodiscard]] bool UnpackSimd(const PackedStream<U>& stream, U* numbers);

}  // namespace lf
