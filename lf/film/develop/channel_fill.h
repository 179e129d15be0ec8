// SPDX-License-Identifier: Apache-2.0
// Fills thin elements (elements with too few rays) of one channel from the collected elements
// (elements with rays) around them (develop.h). Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lf/core/image.h"

namespace lf {

class ChannelFill {
 public:
  // Number of calls of At() after which its caller calls is_interrupted() again. One call of At()
  // takes up to 0.1 ms.
  static constexpr int kFillsPerQuestion = 64;

  //   mean, ray_count  mean value and number of the rays of each element
  //                    [height][width][channels]; must outlive this object
  //   rays_needed      number of rays that averaged neighbours must have together; at least 1
  //   fill_radius_px   largest distance, in elements, from which an element without rays is filled
  //   is_interrupted   called before each row; once it returns true, this object must not be used
  ChannelFill(const Image<float>& mean, const Image<uint32_t>& ray_count, int channel,
              uint32_t rays_needed, int fill_radius_px,
              const std::function<bool()>& is_interrupted);

  // Working memory of one thread, reused from call to call.
  class Scratch;

  // Returns the mean of the collected elements around (x, y), weighted by inverse distance, as
  // Develop() defines it; 0 if no collected element is within RadiusAt(). Finds the radius by
  // counts in squares, each in constant time, and then visits only collected elements, so that
  // empty surroundings cost almost nothing.
  float At(int x, int y, Scratch& scratch) const;
  // Returns true if the last call of At() with this scratch took light from a collected element.
  static bool Found(const Scratch& scratch);

 private:
  struct Collected {
    uint64_t elements = 0;
    uint64_t rays = 0;  // sum of min(number of rays, rays_needed_) over these elements
  };
  struct Neighbour {
    int x;
    int y;
    int64_t distance2;
  };

  // Returns the largest distance, in elements, from which element (x, y) may take light.
  int RadiusAt(int x, int y) const;
  bool IsEnough(const Collected& collected) const;
  size_t SumIndex(int x, int y) const { return (static_cast<size_t>(width_) + 1) * y + x; }
  Collected InSquare(int x, int y, int half_side) const;
  int SmallestSquare(int x, int y, int most) const;
  void FindNeighbours(int x, int y, int64_t radius2, Scratch& scratch) const;
  int64_t SmallestDisk(Scratch& scratch) const;

  const Image<float>& mean_;
  const Image<uint32_t>& ray_count_;
  int width_;
  int height_;
  int channel_;
  uint32_t rays_needed_;
  int fill_radius_px_;

  // Summed-area tables (Crow 1984) of Collected::elements and Collected::rays,
  // [height + 1][width + 1]: entry (x, y) is the sum over the columns before x and the rows
  // before y.
  std::vector<uint32_t> element_sums_;
  std::vector<uint64_t> ray_sums_;  // empty if rays_needed_ is 1, as it would equal element_sums_
  // columns_ holds the column of every collected element, row by row; row_begin_ the index in
  // columns_ at which each row begins.
  std::vector<int> columns_;
  std::vector<size_t> row_begin_;
  // weights_[d^2] is the weight of a neighbour at distance d, in elements: 1 / d, or 2 if d = 0.
  std::vector<double> weights_;
};

class ChannelFill::Scratch {
  friend class ChannelFill;
  struct Ring {
    int64_t distance2;
    uint64_t rays;
  };
  std::vector<Neighbour> neighbours_;  // empty if the last call of At() found no collected element
  std::vector<Ring> nearest_first_;    // heap of the neighbours, the nearest on top
};

inline bool ChannelFill::Found(const Scratch& scratch) { return !scratch.neighbours_.empty(); }

}  // namespace lf
