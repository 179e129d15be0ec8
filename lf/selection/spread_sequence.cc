// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/spread_sequence.h"

#include <array>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr int kBits = 32;
constexpr uint32_t kTopBit = uint32_t{1} << (kBits - 1);
// The best of 300 seeds of MixedIndex(): the sum of the t-values of every second, fourth, eighth
// and sixteenth point, for 2 to 512 points, is the smallest.
constexpr uint64_t kMixingSeed = 100;
constexpr uint64_t kScrambleStream = 2;  // streams of other random numbers: image_order.cc

// The columns of a matrix over the numbers 0 and 1. The highest bit of a column is its first row.
using Columns = std::array<uint32_t, kBits>;

// Returns a matrix whose diagonal is 1, with random bits above the diagonal. It permutes each block
// of 2^m indices that begins at a multiple of 2^m, and no index leaves its block. The lowest bit of
// the result, which decides the half of the square, depends on all bits of the index.
Columns MixedIndex() {
  Columns columns;
  for (uint32_t k = 0; k < kBits; ++k) {
    columns[k] = kTopBit >> k;
    for (uint32_t j = 0; j < k; ++j)
      if ((RandomBits(kMixingSeed, j, k) & 1) != 0) columns[k] |= kTopBit >> j;
  }
  return columns;
}

// Returns the generator matrix of the second coordinate of Sobol's sequence, whose entries are the
// binomial coefficients modulo 2, multiplied by `index`.
Columns PascalTimes(const Columns& index) {
  Columns pascal;
  pascal[0] = kTopBit;
  for (size_t k = 1; k < kBits; ++k) pascal[k] = pascal[k - 1] ^ (pascal[k - 1] >> 1);
  Columns product{};
  for (size_t k = 0; k < kBits; ++k)
    for (size_t j = 0; j < kBits; ++j)
      if ((index[k] & (kTopBit >> j)) != 0) product[k] ^= pascal[j];
  return product;
}

uint32_t Coordinate(const Columns& columns, uint64_t index) {
  uint32_t coordinate = 0;
  for (size_t k = 0; index != 0; ++k, index >>= 1)
    if ((index & 1) != 0) coordinate ^= columns[k];
  return coordinate;
}

// Owen's scrambling: flips each bit of a coordinate or not, by a random number of the bits above
// it. It exchanges the halves of each interval that halving makes, so that the property of the
// sequence remains.
class Scramble {
 public:
  Scramble(uint64_t seed, uint64_t coordinate) {
    for (uint64_t b = 0; b < kBits; ++b)
      of_bits_[b] = RandomBits(seed, kScrambleStream, coordinate * kBits + b);
  }
  uint32_t operator()(uint32_t x) const {
    uint32_t flips = 0;
    for (int b = 0; b < kBits; ++b) {
      const uint64_t above = b == 0 ? 0 : x >> (kBits - b);
      flips |= static_cast<uint32_t>(MixBits(of_bits_[static_cast<size_t>(b)] ^ above) & 1)
               << (kBits - 1 - b);
    }
    return x ^ flips;
  }

 private:
  std::array<uint64_t, kBits> of_bits_;
};

}  // namespace

std::vector<SpreadPoint> SpreadSequence(size_t count, uint64_t seed, uint64_t stream) {
  const Columns across = MixedIndex(), down = PascalTimes(across);
  const Scramble scramble_x(seed, 2 * stream), scramble_y(seed, 2 * stream + 1);
  std::vector<SpreadPoint> points(count);
  for (size_t i = 0; i < count; ++i)
    points[i] = {scramble_x(Coordinate(across, i)), scramble_y(Coordinate(down, i))};
  return points;
}

}  // namespace lf
