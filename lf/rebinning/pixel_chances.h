// SPDX-License-Identifier: Apache-2.0
// A 16-bit random number for every pixel of an LF image, and the pixels chosen by it. Internal to
// rebinning.
//
// Two consecutive pixels share a 32-bit hash (with the constants of C. Wellons's "lowbias32"), one
// half each. It is the hash of the number of the pair in the LF image, mixed with 64 bits that
// depend on the seed and the LF image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/random.h"

namespace lf {

class PixelChances {
 public:
  PixelChances(uint64_t seed, LfImageId id) : stream_(MixBits(MixBits(seed) ^ id.value)) {}

  // Chooses, among consecutive pixels, those whose random number is below their probability p. The
  // unit of p is 1 / 65535: a pixel with p = 65535 is chosen for certain.
  //   first   number of the first pixel, counted row by row of the LF image
  //   chosen  indices into p, ascending; its memory is reused
  void Choose(uint64_t first, std::span<const uint16_t> p, std::vector<uint32_t>* chosen) const;

  // True if Choose() chooses the pixel with this number and this p. This is the reference of
  // Choose().
  bool Chooses(uint64_t pixel, uint16_t p) const {
    auto hash = static_cast<uint32_t>(pixel / 2) ^ static_cast<uint32_t>(stream_);
    hash ^= hash >> 16;
    hash = hash * kFirst + static_cast<uint32_t>(stream_ >> 32);
    hash ^= hash >> 15;
    hash *= kSecond;
    hash ^= hash >> 16;
    return ((hash >> (16 * (pixel % 2)) & 0xffff) * 65535 >> 16) < p;
  }

  static constexpr uint32_t kFirst = 0x7feb352d, kSecond = 0x846ca68b;

 private:
  uint64_t stream_;
};

}  // namespace lf
