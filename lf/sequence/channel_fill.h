// Thin elements of one colour channel, filled from the collected ones around them (develop.h).
// Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lf/core/image.h"

namespace lf {

class ChannelFill {
 public:
  // mean, ray_count  [height][width][channels]; own average and rays of every element; must
  //                  outlive this
  // rays_needed      what the rays around an element must add up to; at least 1
  // fill_radius_px   how far elements without a ray look, DevelopOptions
  // is_interrupted   asked before each row; once it is true, this is of no use
  ChannelFill(const Image<float>& mean, const Image<uint32_t>& ray_count, int channel,
              uint32_t rays_needed, int fill_radius_px,
              const std::function<bool()>& is_interrupted);

  // Memory of one thread, kept from call to call.
  class Scratch;

  // The inverse-distance mean at (x, y), as Develop() defines it; 0 where nothing is near.
  // Finds the radius by counting in squares, each in constant time, then looks at collected
  // elements alone: empty surroundings cost next to nothing.
  float At(int x, int y, Scratch& scratch) const;

 private:
  struct Collected {
    uint64_t elements = 0;
    uint64_t rays = 0;  // of every element at most rays_needed
  };
  struct Neighbour {
    int x;
    int y;
    int64_t distance2;
  };

  // How far the element looks.
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

  // Summed-area tables (Crow 1984), [height + 1][width + 1]: how much lies above and to the left.
  std::vector<uint32_t> element_sums_;
  std::vector<uint64_t> ray_sums_;  // empty if rays_needed is 1: then elements say it all
  // Column of every collected element, row by row; where each row begins.
  std::vector<int> columns_;
  std::vector<size_t> row_begin_;
  std::vector<double> weights_;  // 1 / d, by d^2
};

class ChannelFill::Scratch {
  friend class ChannelFill;
  struct Ring {
    int64_t distance2;
    uint64_t rays;
  };
  std::vector<Neighbour> neighbours_;
  std::vector<Ring> nearest_first_;  // a heap of them
};

}  // namespace lf
