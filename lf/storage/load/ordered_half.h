// SPDX-License-Identifier: Apache-2.0
// Represents the radiance of float files as 16-bit integers, so that packed stores can encode it:
// the bit patterns of half floats (IEEE 754 binary16), mapped such that larger numbers become
// larger integers.
#pragma once

#include <bit>
#include <cstdint>

namespace lf {

// Returns the half nearest to `value`, ties to even; infinite if |value| >= 65520. NaN counts as 0.
inline uint16_t HalfOf(float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  const auto sign = static_cast<uint16_t>(bits >> 16 & 0x8000);
  const uint32_t magnitude = bits & 0x7FFFFFFF;
  if (magnitude > 0x7F800000) return 0;
  constexpr uint32_t kTooLarge = 0x477FF000;  // 65520; from here on infinity is nearest
  if (magnitude >= kTooLarge) return sign | 0x7C00;
  // `shift` is the number of bits by which a half's significand is shorter than the float's. The
  // biases of the exponents differ by 112; below 2^-14 halves have a fixed step of 2^-24.
  const uint32_t exponent = magnitude >> 23;
  const bool is_normal = exponent > 112;
  if (!is_normal && exponent < 102) return sign;
  const uint32_t significand =
      is_normal ? magnitude - (112U << 23) : (magnitude & 0x7FFFFF) | 0x800000;
  const uint32_t shift = is_normal ? 13 : 126 - exponent;
  const uint32_t rest = significand & ((1U << shift) - 1), middle = 1U << (shift - 1);
  uint32_t half = significand >> shift;
  if (rest > middle || (rest == middle && (half & 1) != 0)) ++half;
  return static_cast<uint16_t>(sign | half);
}

inline float FloatOfHalf(uint16_t half) {
  const uint32_t sign = (half & 0x8000U) << 16, exponent = half >> 10 & 0x1F, rest = half & 0x3FF;
  if (exponent == 0) {
    const float tiny = static_cast<float>(rest) * 0x1p-24f;
    return sign != 0 ? -tiny : tiny;
  }
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7F800000 | rest << 13);
  return std::bit_cast<float>(sign | (exponent + 112) << 23 | rest << 13);
}

inline uint16_t OrderedOfHalf(uint16_t half) {
  return static_cast<uint16_t>((half & 0x8000) != 0 ? ~half : half | 0x8000);
}

// Returns the half of an ordered integer. Integers beyond those of the two infinities, which lossy
// encoding may produce, become infinities, never NaN.
inline uint16_t HalfOfOrdered(uint16_t ordered) {
  constexpr uint16_t kLeast = 0x03FF, kMost = 0xFC00;
  if (ordered < kLeast) ordered = kLeast;
  if (ordered > kMost) ordered = kMost;
  return static_cast<uint16_t>((ordered & 0x8000) != 0 ? ordered & 0x7FFF : ~ordered);
}

inline uint16_t OrderedOfFloat(float value) { return OrderedOfHalf(HalfOf(value)); }
inline float FloatOfOrdered(uint16_t ordered) { return FloatOfHalf(HalfOfOrdered(ordered)); }

}  // namespace lf
