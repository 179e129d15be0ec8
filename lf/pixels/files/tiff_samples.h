// SPDX-License-Identifier: Apache-2.0
// Converts the samples of a TIFF file to the types of a StoredImage. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "lf/pixels/files/image_file.h"

namespace lf {

// The type of the samples in a file.
struct TiffSamples {
  enum class Kind { kUnsigned, kSigned, kFloat };
  Kind kind = Kind::kUnsigned;
  int bits = 8;
};

// True if samples of this type can be converted: unsigned integers of 1 to 16, 32 and 64 bits,
// signed integers of 8, 16, 32 and 64 bits, and floats of 16, 32 and 64 bits.
bool CanConvert(const TiffSamples& samples);

// Returns the number of bits of the values of a StoredImage that the samples become: 8, 16 or 32.
int StoredBitsOf(const TiffSamples& samples);

// True if samples of this type are stored as values of type T, so that they need no conversion.
template <class T>
bool IsStoredAs(const TiffSamples& samples) {
  const auto kind =
      std::is_floating_point_v<T> ? TiffSamples::Kind::kFloat : TiffSamples::Kind::kUnsigned;
  return samples.kind == kind && samples.bits == 8 * static_cast<int>(sizeof(T));
}

// Converts `count` samples. Samples of 8, 16, 32 or 64 bits have the byte order of this machine.
// Samples of other sizes are packed, the most significant bit first. Sample i becomes
// to[i * to_step]. T must have StoredBitsOf(samples) bits.
// - Unsigned integers of up to 16 bits are scaled to the full range of T, rounded down.
// - Other integers and doubles become the nearest float.
template <class T>
void ConvertSamples(const TiffSamples& samples, const std::byte* from, size_t count, T* to,
                    size_t to_step);

// Copies `count` unsigned samples of 1 to 16 bits without scaling them.
void UnpackIndices(const TiffSamples& samples, const std::byte* from, size_t count, uint16_t* to);

}  // namespace lf
