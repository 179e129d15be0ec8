// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/block_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "lf/core/check.h"

namespace lf {
namespace {

// Costs are sums of absolute differences, times kCostUnit.
constexpr int kCostUnit = 16;

// Choices of a block: index depth * modes + mode. Mode 0 is the mean of all reference images, mode
// r the one with index r - 1; a single reference image has mode 0 alone.
struct Modes {
  explicit Modes(size_t references)
      : all(static_cast<uint8_t>((1U << references) - 1)),
        count(references > 1 ? static_cast<int>(references) + 1 : 1) {}
  uint8_t MaskOf(int mode) const {
    return mode == 0 ? all : static_cast<uint8_t>(1U << (mode - 1));
  }

  uint8_t all;
  int count;
};

// Returns the sum of absolute differences of `count` values.
uint32_t Difference(const uint8_t* a, const uint8_t* b, int count) {
  uint32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += static_cast<uint32_t>(std::abs(a[i] - b[i]));
  return sum;
}

// Sets each value of `mean` to the mean of the images, rounded.
void SetMean(std::span<const Image<uint8_t>> images, int width, int height, Image<uint8_t>* mean) {
  const auto count = static_cast<int>(images.size());
  for (int y = 0; y < height; ++y) {
    uint8_t* const out = mean->row(y);
    if (count == 2) {
      const uint8_t *a = images[0].row(y), *b = images[1].row(y);
      for (int x = 0; x < width; ++x) out[x] = static_cast<uint8_t>((a[x] + b[x] + 1) >> 1);
    } else if (count == 3) {
      const uint8_t *a = images[0].row(y), *b = images[1].row(y), *c = images[2].row(y);
      for (int x = 0; x < width; ++x)
        out[x] = static_cast<uint8_t>((6 * a[x] + 5 * b[x] + 5 * c[x] + 8) >> 4);
    } else {
      const uint8_t *a = images[0].row(y), *b = images[1].row(y);
      const uint8_t *c = images[2].row(y), *d = images[3].row(y);
      for (int x = 0; x < width; ++x)
        out[x] = static_cast<uint8_t>((a[x] + b[x] + c[x] + d[x] + 2) >> 2);
    }
  }
}

// The depths that are compared for a block: bit d stands for depth d.
using Depths = uint64_t;
constexpr Depths kEvenDepths = 0x5555555555555555;

// Returns the warp for positions that are `shift` pixels farther to the right and down.
PlaneWarp Shifted(PlaneWarp warp, int shift) {
  for (auto& row : warp.far) row[2] -= shift * (row[0] + row[1]);
  return warp;
}

// Returns the warp between pictures of half the size: pixel x is the mean of 2 x and 2 x + 1.
PlaneWarp HalvedWarp(const PlaneWarp& warp) {
  PlaneWarp halved = warp;
  for (int row = 0; row < 3; ++row) {
    const auto [across, down, origin] = warp.far[row];
    halved.far[row] = {2 * across, 2 * down, origin + (across + down) / 2};
  }
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 3; ++i)
      halved.far[row][i] = (halved.far[row][i] - halved.far[2][i] / 2) / 2;
    halved.step[row] = (warp.step[row] - warp.step[2] / 2) / 2;
  }
  return halved;
}

// Returns the picture of half the size, rounded up.
Image<uint8_t> HalvedImage(const Image<uint8_t>& image) {
  Image<uint8_t> halved((image.width() + 1) / 2, (image.height() + 1) / 2);
  for (int y = 0; y < halved.height(); ++y) {
    const uint8_t* const upper = image.row(2 * y);
    const uint8_t* const lower = image.row(std::min(2 * y + 1, image.height() - 1));
    uint8_t* const out = halved.row(y);
    for (int x = 0; x < image.width() / 2; ++x)
      out[x] = static_cast<uint8_t>(
          (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) >> 2);
    if (image.width() % 2 == 1)
      out[halved.width() - 1] =
          static_cast<uint8_t>((upper[image.width() - 1] + lower[image.width() - 1] + 1) >> 1);
  }
  return halved;
}

// Finds the blocks of an image, one row of blocks after the other.
class BlockSearch {
 public:
  BlockSearch(const Image<uint8_t>& brightness, std::span<const Image<uint8_t>> references,
              std::span<const PlaneWarp> warps, const SearchSettings& settings)
      : brightness_(brightness),
        modes_(references.size()),
        side_(1 << settings.block_bits),
        blocks_(MakeBlockField(brightness.width(), brightness.height(), settings.block_bits, 0)),
        cost_of_bit_(std::lround(kCostUnit * std::clamp(0.8 * settings.step, 1.0, 1000.0))),
        costs_(static_cast<size_t>(blocks_.columns) * kDepthSteps * modes_.count),
        choices_(blocks_.columns) {
    for (size_t r = 0; r < references.size(); ++r) {
      // With pixels that are half a block farther, each block is a cell (predict.h). All cells have
      // the depth of the single block of the field.
      plans_.push_back(
          {{Shifted(warps[r], side_ / 2)}, MakeBlockField(1, 1, settings.block_bits, 1)});
      parts_.push_back({references[r].view(), 0, 0, references[r].width(), references[r].height()});
      warped_.emplace_back(brightness.width(), side_);
    }
    mean_ = Image<uint8_t>(brightness.width(), side_);
  }

  // Compares the same depths in all blocks.
  BlockField FoundOf(Depths depths) && {
    for (int row = 0; row < blocks_.rows; ++row) {
      std::fill(costs_.begin(), costs_.end(), kNotCompared);
      for (int depth = 0; depth < kDepthSteps; ++depth)
        if ((depths >> depth & 1) != 0) Compare(row, 0, blocks_.columns, depth);
      Choose(row);
    }
    return std::move(blocks_);
  }

  // Compares depths(column, row) in each block.
  template <class DepthsOf>
  BlockField Found(const DepthsOf& depths) && {
    for (int row = 0; row < blocks_.rows; ++row) {
      std::fill(costs_.begin(), costs_.end(), kNotCompared);
      for (int column = 0; column < blocks_.columns; ++column) {
        const Depths of_block = depths(column, row);
        for (int depth = 0; depth < kDepthSteps; ++depth)
          if ((of_block >> depth & 1) != 0) Compare(row, column, column + 1, depth);
      }
      Choose(row);
    }
    return std::move(blocks_);
  }

 private:
  static constexpr int64_t kNotCompared = INT64_MAX / 2;

  int ChoiceCount() const { return kDepthSteps * modes_.count; }

  // Sets the costs of some blocks of a row, from `begin` to before `end`, at one depth.
  void Compare(int row, int begin, int end, int depth) {
    const int x_begin = begin * side_, x_end = std::min(end * side_, brightness_.width());
    const int y_begin = row * side_, y_end = std::min(y_begin + side_, brightness_.height());
    const int shift = side_ / 2;
    const PixelRect rect = {x_begin + shift, y_begin + shift, x_end + shift, y_end + shift};
    for (size_t r = 0; r < plans_.size(); ++r) {
      plans_[r].blocks.depths[0] = static_cast<uint8_t>(depth);
      ImageView<uint8_t> strip = warped_[r].view();
      strip.width = rect.width();
      strip.height = rect.height();
      Predict<uint8_t>(plans_[r], std::span(parts_).subspan(r, 1), rect, strip);
    }
    if (modes_.count > 1) SetMean(warped_, rect.width(), rect.height(), &mean_);
    for (int mode = 0; mode < modes_.count; ++mode) {
      const Image<uint8_t>& predicted = modes_.count == 1 ? warped_[0]
                                        : mode == 0       ? mean_
                                                          : warped_[mode - 1];
      for (int column = begin; column < end; ++column) {
        const int x = column * side_, width = std::min(side_, x_end - x);
        uint32_t sum = 0;
        for (int y = 0; y < rect.height(); ++y)
          sum +=
              Difference(brightness_.row(y_begin + y) + x, predicted.row(y) + x - x_begin, width);
        costs_[static_cast<size_t>(column) * ChoiceCount() + depth * modes_.count + mode] =
            int64_t{kCostUnit} * sum;
      }
    }
  }

  // Chooses the depths and masks of a row of blocks, in three passes: each block in turn takes the
  // choice that costs least with what its neighbours on the left, right and above have.
  void Choose(int row) {
    constexpr int kPasses = 3;
    const int columns = blocks_.columns;
    for (int pass = 0; pass < kPasses; ++pass)
      for (int column = 0; column < columns; ++column) {
        std::array<int, 3> around{};
        int count = 0;
        if (column > 0) around[count++] = choices_[column - 1];
        if (row > 0) around[count++] = upper_choices_[column];
        if (pass > 0 && column + 1 < columns) around[count++] = choices_[column + 1];
        choices_[column] = Best(column, std::span(around).first(count));
      }
    for (int column = 0; column < columns; ++column) {
      const size_t block = static_cast<size_t>(row) * columns + column;
      blocks_.depths[block] = static_cast<uint8_t>(choices_[column] / modes_.count);
      blocks_.masks[block] = modes_.MaskOf(choices_[column] % modes_.count);
    }
    upper_choices_ = choices_;
  }

  // Returns the choice of a block that costs least beside blocks with the choices `around`.
  int Best(int column, std::span<const int> around) {
    // Bits are counted in halves, because each border of two blocks has two sides.
    std::array<int64_t, kDepthSteps> of_depth{};
    std::array<int64_t, kMostReferences + 1> of_mode{};
    for (const int neighbour : around) {
      const int depth = neighbour / modes_.count, mode = neighbour % modes_.count;
      for (int d = 0; d < kDepthSteps; ++d) {
        const int apart = std::abs(d - depth);
        of_depth[d] += cost_of_bit_ * (apart == 0 ? 0 : apart == 1 ? 2 : apart < 4 ? 4 : 6) / 2;
      }
      for (int m = 0; m < modes_.count; ++m) of_mode[m] += m == mode ? 0 : cost_of_bit_ * 2 / 2;
    }
    const int64_t* const costs = costs_.data() + static_cast<size_t>(column) * ChoiceCount();
    int best = 0;
    int64_t least = INT64_MAX;
    for (int d = 0; d < kDepthSteps; ++d)
      for (int m = 0; m < modes_.count; ++m) {
        const int choice = d * modes_.count + m;
        const int64_t cost = costs[choice] + of_depth[d] + of_mode[m];
        if (cost < least) {
          least = cost;
          best = choice;
        }
      }
    return best;
  }

  const Image<uint8_t>& brightness_;
  const Modes modes_;
  const int side_;
  BlockField blocks_;
  const int64_t cost_of_bit_;
  std::vector<int64_t> costs_;  // [column][choice] of a row of blocks
  std::vector<int> choices_, upper_choices_;
  std::vector<PredictionPlan> plans_;  // for each reference image alone
  std::vector<ReferencePart<uint8_t>> parts_;
  std::vector<Image<uint8_t>> warped_;  // rows of blocks as each reference image predicts them
  Image<uint8_t> mean_;
};

}  // namespace

BlockField SearchBlocks(const Image<uint8_t>& brightness,
                        std::span<const Image<uint8_t>> references,
                        std::span<const PlaneWarp> warps, const SearchSettings& settings) {
  LF_CHECK(!references.empty() && references.size() <= kMostReferences &&
           references.size() == warps.size());
  BlockSearch search(brightness, references, warps, settings);
  // Every second depth is compared in pictures of half the size, where its disparity is that of all
  // depths here. Then only depths near those that were found are compared.
  std::vector<Image<uint8_t>> halved_references;
  std::vector<PlaneWarp> halved_warps;
  for (size_t r = 0; r < references.size(); ++r) {
    halved_references.push_back(HalvedImage(references[r]));
    halved_warps.push_back(HalvedWarp(warps[r]));
  }
  const SearchSettings of_halved = {std::max(settings.block_bits - 1, kLeastBlockBits),
                                    settings.step / 8};
  const Image<uint8_t> halved = HalvedImage(brightness);
  const BlockField coarse =
      BlockSearch(halved, halved_references, halved_warps, of_halved).FoundOf(kEvenDepths);
  const int shift = of_halved.block_bits + 1 - settings.block_bits;
  return std::move(search).Found([&](int column, int row) {
    const auto depth_at = [&](int x, int y) {
      const int nearest_x = std::clamp(x, 0, coarse.columns - 1);
      const int nearest_y = std::clamp(y, 0, coarse.rows - 1);
      return coarse.depths[static_cast<size_t>(nearest_y) * coarse.columns + nearest_x];
    };
    const int x = column >> shift, y = row >> shift;
    const int depth = depth_at(x, y);
    Depths depths = 0;
    for (int d = std::max(depth - 2, 0); d <= std::min(depth + 2, kDepthSteps - 1); ++d)
      depths |= Depths{1} << d;
    for (const auto& [across, down] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
      depths |= Depths{1} << depth_at(x + across, y + down);
    return depths;
  });
}

}  // namespace lf
