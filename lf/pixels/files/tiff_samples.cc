// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/tiff_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lf/core/check.h"

namespace lf {
namespace {

using Kind = TiffSamples::Kind;

// Returns the value of a half-precision float (IEEE 754 binary16).
float FloatOfHalf(uint16_t half) {
  const uint32_t sign = uint32_t{half} >> 15 << 31;
  const uint32_t exponent = half >> 10 & 31;
  const uint32_t fraction = half & 1023;
  constexpr uint32_t kSpecial = 31, kExponentOffset = 127 - 15;
  if (exponent == 0)  // zero or denormal
    return std::bit_cast<float>(std::bit_cast<uint32_t>(std::ldexp(float(fraction), -24)) | sign);
  const uint32_t wide_exponent = exponent == kSpecial ? 255 : exponent + kExponentOffset;
  return std::bit_cast<float>(sign | wide_exponent << 23 | fraction << 13);
}

// A half, which is stored in a type of its own so that Widen() can tell it from an integer.
struct Half {
  uint16_t bits;
  explicit operator float() const { return FloatOfHalf(bits); }
};

template <class From>
void Widen(const std::byte* from, size_t count, float* to, size_t to_step) {
  for (size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, from + i * sizeof(From), sizeof(From));
    to[i * to_step] = static_cast<float>(value);
  }
}

void ConvertToFloats(const TiffSamples& samples, const std::byte* from, size_t count, float* to,
                     size_t to_step) {
  if (samples.kind == Kind::kFloat) {
    if (samples.bits == 16) return Widen<Half>(from, count, to, to_step);
    if (samples.bits == 32) return Widen<float>(from, count, to, to_step);
    return Widen<double>(from, count, to, to_step);
  }
  if (samples.kind == Kind::kUnsigned) {
    if (samples.bits == 32) return Widen<uint32_t>(from, count, to, to_step);
    return Widen<uint64_t>(from, count, to, to_step);
  }
  if (samples.bits == 8) return Widen<int8_t>(from, count, to, to_step);
  if (samples.bits == 16) return Widen<int16_t>(from, count, to, to_step);
  if (samples.bits == 32) return Widen<int32_t>(from, count, to, to_step);
  return Widen<int64_t>(from, count, to, to_step);
}

// Calls use(i, value) for each of `count` integers of `bits` (1 to 16) bits, which are packed with
// the most significant bit first.
template <class Use>
void ForEachPacked(int bits, const std::byte* from, size_t count, const Use& use) {
  uint32_t buffer = 0;
  int buffered_bits = 0;
  for (size_t i = 0; i < count; ++i) {
    for (; buffered_bits < bits; buffered_bits += 8)
      buffer = buffer << 8 | std::to_integer<uint32_t>(*from++);
    buffered_bits -= bits;
    use(i, buffer >> buffered_bits & ((uint32_t{1} << bits) - 1));
  }
}

template <class T>
void CopyIntegers(const std::byte* from, size_t count, T* to, size_t to_step) {
  for (size_t i = 0; i < count; ++i) std::memcpy(to + i * to_step, from + i * sizeof(T), sizeof(T));
}

}  // namespace

bool CanConvert(const TiffSamples& samples) {
  const int bits = samples.bits;
  if (bits == 32 || bits == 64 || bits == 16) return true;
  if (samples.kind == Kind::kSigned) return bits == 8;
  return samples.kind == Kind::kUnsigned && bits >= 1 && bits <= 16;
}

int StoredBitsOf(const TiffSamples& samples) {
  if (samples.kind != Kind::kUnsigned || samples.bits > 16) return 32;
  return samples.bits <= 8 ? 8 : 16;
}

template <class T>
void ConvertSamples(const TiffSamples& samples, const std::byte* from, size_t count, T* to,
                    size_t to_step) {
  LF_DCHECK(CanConvert(samples) && StoredBitsOf(samples) == 8 * sizeof(T));
  if constexpr (std::is_same_v<T, float>) {
    ConvertToFloats(samples, from, count, to, to_step);
  } else if (samples.bits == 8 * sizeof(T)) {
    CopyIntegers(from, count, to, to_step);
  } else {
    const uint32_t highest = (uint32_t{1} << samples.bits) - 1;
    ForEachPacked(samples.bits, from, count, [&](size_t i, uint32_t value) {
      to[i * to_step] = static_cast<T>(value * std::numeric_limits<T>::max() / highest);
    });
  }
}
template void ConvertSamples(const TiffSamples&, const std::byte*, size_t, uint8_t*, size_t);
template void ConvertSamples(const TiffSamples&, const std::byte*, size_t, uint16_t*, size_t);
template void ConvertSamples(const TiffSamples&, const std::byte*, size_t, float*, size_t);

void UnpackIndices(const TiffSamples& samples, const std::byte* from, size_t count, uint16_t* to) {
  LF_DCHECK(samples.kind == Kind::kUnsigned && samples.bits <= 16);
  if (samples.bits == 16) return CopyIntegers(from, count, to, 1);
  ForEachPacked(samples.bits, from, count,
                [&](size_t i, uint32_t value) { to[i] = static_cast<uint16_t>(value); });
}

}  // namespace lf
