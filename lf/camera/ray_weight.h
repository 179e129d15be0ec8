// SPDX-License-Identifier: Apache-2.0
// Weights of rays: how much a ray counts in the mean of an element (doc/ray.md, "What is added").
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "lf/core/geometry.h"

namespace lf {

// Largest weight of a ray. Weights are integers, in proportion to the part of the lens that the
// ray's LF camera stands for. A ray of radiance v adds weight * v to the sum of its element and
// weight to the element's count. A ray of weight 0 adds nothing.
inline constexpr uint32_t kMaxWeight = 255;

// Side of a block, in elements. For each LF image, the plate is divided into blocks of 8 x 8
// elements; rays that land in one block have the same weight, apart from the feather. The blocks of
// different LF images begin at different elements; otherwise the borders of their blocks would add
// up to a pattern.
inline constexpr int kWeightBlock = 8;

struct WeightBlocks {
  // Blocks begin at x = 8 i - shift_x and y = 8 i - shift_y; both shifts are in [0, kWeightBlock).
  int shift_x = 0;
  int shift_y = 0;

  // EndX() returns the exclusive end of the block that contains column x of the plate, EndY() that
  // of the block that contains row y.
  int EndX(int x) const { return ((x + shift_x) / kWeightBlock + 1) * kWeightBlock - shift_x; }
  int EndY(int y) const { return ((y + shift_y) / kWeightBlock + 1) * kWeightBlock - shift_y; }
};

// The feather of a ray that keeps its whole weight. The feather is the share of a ray's weight that
// is left near the borders of its LF image: from 0 at the border to kWholeFeather inside.
inline constexpr uint32_t kWholeFeather = 256;

// Returns the weight of the element in column i and row j of a block: the block's weight times the
// feather, which is interpolated bilinearly to the element's centre.
//   weight    the block's weight
//   above     feather at the two upper corners of the block: left, right
//   below     feather at the two lower corners of the block: left, right
// The result is at least 1 if the block's weight is not 0, because a recorded ray always counts.
inline uint32_t FeatheredWeight(uint32_t weight, const uint16_t* above, const uint16_t* below,
                                int i, int j) {
  constexpr uint32_t kOne = 2 * kWeightBlock;
  const auto right = static_cast<uint32_t>(2 * i + 1), down = static_cast<uint32_t>(2 * j + 1);
  const uint32_t upper = above[0] * (kOne - right) + above[1] * right;
  const uint32_t lower = below[0] * (kOne - right) + below[1] * right;
  const uint32_t feather = upper * (kOne - down) + lower * down;
  constexpr uint32_t kWhole = kWholeFeather * kOne * kOne;
  return std::max(std::min(weight, 1U), (weight * feather + kWhole / 2) / kWhole);
}

// Weights of the rays of one LF image in one frame.
class RayWeights {
 public:
  // Gives all elements of the plate the same weight, at most kMaxWeight.
  RayWeights(uint32_t weight = 1) : same_(weight) {}  // NOLINT: implicit on purpose
  // Writes the weights, at most kMaxWeight, of `count` blocks of a row, from left to right. (end_x,
  // end_y) is the exclusive end of the first block. Any thread may call it.
  using RowFunction = std::function<void(int end_x, int end_y, int count, uint8_t* weights)>;
  // Writes the feather, at most kWholeFeather, at the positions (x + kWeightBlock i, y +
  // kWeightBlock j) of the plate, which are corners of blocks, to feather[j * columns + i]; i is in
  // [0, columns), j in [0, rows). Any thread may call it.
  using FeatherFunction =
      std::function<void(int x, int y, int columns, int rows, uint16_t* feather)>;
  // Returns true only if the feather is kWholeFeather at all positions (x, y) of the plate with
  // x_begin <= x <= x_end and y_begin <= y <= y_end. May return false although the feather is
  // whole. Any thread may call it.
  using WholeFunction = std::function<bool(const PixelRect& rect)>;
  // Gives each block its own weight.
  //   feather           empty if the LF image has no feather
  //   feather_is_whole  empty: the feather is not known to be whole anywhere
  RayWeights(const WeightBlocks& blocks, RowFunction of_row, FeatherFunction feather = {},
             WholeFunction feather_is_whole = {})
      : blocks_(blocks),
        of_row_(std::move(of_row)),
        feather_(std::move(feather)),
        feather_is_whole_(std::move(feather_is_whole)) {}

  bool are_same() const { return of_row_ == nullptr; }
  uint32_t same() const { return same_; }
  // True if all elements have the same weight, 0, so that the LF image adds nothing to the plate.
  // False if blocks have their own weights, even if all of these are 0.
  bool are_none() const { return are_same() && same_ == 0; }
  bool has_feather() const { return feather_ != nullptr; }
  const WeightBlocks& blocks() const { return blocks_; }

  // Returns the weight of element (x, y).
  uint32_t At(int x, int y) const {
    if (are_same()) return same_;
    uint8_t weight = 0;
    OfRow(x, y, 1, &weight);
    if (!has_feather() || weight == 0) return weight;
    const int begin_x = blocks_.EndX(x) - kWeightBlock, begin_y = blocks_.EndY(y) - kWeightBlock;
    uint16_t corners[4];
    feather_(begin_x, begin_y, 2, 2, corners);
    return FeatheredWeight(weight, corners, corners + 2, x - begin_x, y - begin_y);
  }
  // Writes the weights of `count` blocks of a row, from left to right, without feather. The first
  // block contains element (x, y). Must not be called if are_same() is true.
  void OfRow(int x, int y, int count, uint8_t* weights) const {
    of_row_(blocks_.EndX(x), blocks_.EndY(y), count, weights);
  }
  // Returns true only if no ray that lands in these elements loses weight by the feather. May
  // return false although no ray does.
  bool FeatherIsWhole(const PixelRect& elements) const {
    if (!has_feather()) return true;
    if (!feather_is_whole_) return false;
    return feather_is_whole_({blocks_.EndX(elements.x_begin) - kWeightBlock,
                              blocks_.EndY(elements.y_begin) - kWeightBlock,
                              blocks_.EndX(elements.x_end - 1), blocks_.EndY(elements.y_end - 1)});
  }
  // Writes the feather at corners of blocks, as FeatherFunction does. has_feather() must be true.
  void FeatherOfCorners(int x, int y, int columns, int rows, uint16_t* feather) const {
    feather_(x, y, columns, rows, feather);
  }

 private:
  uint32_t same_ = 1;
  WeightBlocks blocks_;
  RowFunction of_row_;
  FeatherFunction feather_;
  WholeFunction feather_is_whole_;
};

}  // namespace lf
