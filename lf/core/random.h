// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a number depends on (seed, stream, index) alone, so that it is the
// same on any thread, in any order of calls, on any machine.
#pragma once

#include <cstdint>

namespace lf {

// The SplitMix64 finalizer (Steele, Lea, Flood 2014): a bijection that mixes all bits.
inline uint64_t MixBits(uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

inline uint64_t RandomBits(uint64_t seed, uint64_t stream, uint64_t index) {
  return MixBits(MixBits(MixBits(seed) ^ stream) ^ index);
}

// Returns a number that is uniformly distributed in [0, 1).
inline double RandomUnit(uint64_t seed, uint64_t stream, uint64_t index) {
  return static_cast<double>(RandomBits(seed, stream, index) >> 11) * 0x1.0p-53;
}

// A sequence of random numbers, for callers that do not want to keep count of the index.
class RandomSequence {
 public:
  explicit RandomSequence(uint64_t seed) : seed_(seed) {}
  double Uniform(double low, double high) {
    return low + (high - low) * RandomUnit(seed_, 0, index_++);
  }

 private:
  uint64_t seed_;
  uint64_t index_ = 0;
};

}  // namespace lf
