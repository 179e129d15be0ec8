// How much a ray counts (doc/ray.md, "What is added").
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace lf {

// Weights are integers, the part of the lens that the ray's LF camera stands for: sum += weight v,
// count += weight. A ray of weight 0 adds nothing.
inline constexpr uint32_t kMaxWeight = 255;

// Blocks of 8 x 8 elements of the plate have one weight. Every LF image has blocks of its own,
// which begin elsewhere, so that the borders of all of them do not add up to a pattern.
inline constexpr int kWeightBlock = 8;

struct WeightBlocks {
  // In [0, kWeightBlock): blocks begin at x = 8 i - shift_x.
  int shift_x = 0;
  int shift_y = 0;

  // The end of the block that x lies in; likewise for y.
  int EndX(int x) const { return ((x + shift_x) / kWeightBlock + 1) * kWeightBlock - shift_x; }
  int EndY(int y) const { return ((y + shift_y) / kWeightBlock + 1) * kWeightBlock - shift_y; }
};

// What the rays of one LF image count in one frame.
class RayWeights {
 public:
  // The same all over the plate, at most kMaxWeight.
  RayWeights(uint32_t weight = 1) : same_(weight) {}  // NOLINT: a number is such weights
  // At most kMaxWeight, of `count` blocks side by side, the first of which ends before (end_x,
  // end_y).
  using RowFunction = std::function<void(int end_x, int end_y, int count, uint8_t* weights)>;
  RayWeights(const WeightBlocks& blocks, RowFunction of_row)
      : blocks_(blocks), of_row_(std::move(of_row)) {}

  bool are_same() const { return of_row_ == nullptr; }
  uint32_t same() const { return same_; }
  // The image takes no part.
  bool are_none() const { return are_same() && same_ == 0; }
  const WeightBlocks& blocks() const { return blocks_; }
  // Of element (x, y).
  uint32_t At(int x, int y) const {
    if (are_same()) return same_;
    uint8_t weight = 0;
    of_row_(blocks_.EndX(x), blocks_.EndY(y), 1, &weight);
    return weight;
  }
  // Of as many blocks from that of element (x, y) on, side by side; not where are_same().
  void OfRow(int x, int y, int count, uint8_t* weights) const {
    of_row_(blocks_.EndX(x), blocks_.EndY(y), count, weights);
  }

 private:
  uint32_t same_ = 1;
  WeightBlocks blocks_;
  RowFunction of_row_;
};

}  // namespace lf
