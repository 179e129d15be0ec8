// A random number of 16 bits for every pixel of an LF image, and which pixels it chooses. Internal
// to rebinning.
//
// Of two pixels it is the halves of a 32-bit hash (by the constants of C. Wellons's "lowbias32") of
// their number in the LF image, mixed with 64 bits of seed and LF image.
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

  // Which of consecutive pixels have a number below their p, which is in 1 / 65535: that is
  // certain.
  //   first   number of the first, row by row of the LF image
  //   chosen  its memory is used again
  void Choose(uint64_t first, std::span<const uint16_t> p, std::vector<uint32_t>* chosen) const;

  // Whether one is: the judge.
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
