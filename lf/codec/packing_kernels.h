// The implementations behind packing.h, for unsigned numbers of 16 and 32 bits. Internal to codec.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/codec/packing.h"

namespace lf {

inline int PerByte(Packing packing) { return static_cast<int>(packing); }
inline bool IsPlanes(Packing packing) { return packing >= Packing::kPlanes2; }
inline int PlaneCount(Packing packing) { return static_cast<int>(packing) - 16; }
// What stands for an escape; smaller numbers are as they are.
inline uint32_t EscapeOf(Packing packing) { return (1u << (8 / PerByte(packing))) - 1; }

// Numbers out of their bytes; not kZeros. `numbers` has slack.
template <class U>
void UnpackReference(Packing packing, const uint8_t* bytes, size_t count, U* numbers);
template <class U>
void UnpackSimd(Packing packing, const uint8_t* bytes, size_t count, U* numbers);

// Adds the next of `escapes` to every number that is `escape`. Both have slack. Answers how many
// there were; those beyond `escape_count` may have any value.
template <class U>
size_t AddEscapesReference(U escape, const U* escapes, size_t escape_count, size_t count,
                           U* numbers);
template <class U>
size_t AddEscapesSimd(U escape, const U* escapes, size_t escape_count, size_t count, U* numbers);

// Signs out of the lowest bit, in place. `numbers` has slack.
template <class U>
void UnfoldReference(size_t count, U* numbers);
template <class U>
void UnfoldSimd(size_t count, U* numbers);

}  // namespace lf
