// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_guard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr uint64_t kGuardSeed = 67;
// Largest error of colours from neighbours, as a share of that of demosaicking: 1.2 dB less. It
// leaves room for chance, by which wrong colours seem right in a few blocks.
constexpr double kMostError = 0.75;

int BlockCount(int pixels) { return (pixels + kGuardBlock_px - 1) / kGuardBlock_px; }

// The place of a pixel between the middles of blocks along one axis.
struct Between {
  int before, after;  // blocks
  float share;        // weight of `after` in the result
};
Between BlocksAt(int pixel, int block_count) {
  const float place = (static_cast<float>(pixel) + 0.5F) / kGuardBlock_px - 0.5F;
  const float before = std::floor(place);
  const int block = static_cast<int>(before);
  return {std::clamp(block, 0, block_count - 1), std::clamp(block + 1, 0, block_count - 1),
          place - before};
}

GuardErrors ErrorsOfBlock(const JointImage& image, const Image<float>& other,
                          const Image<uint8_t>& is_tested, const Image<float>& tested, int block_x,
                          int block_y) {
  GuardErrors errors;
  const int x_end = std::min(image.width(), (block_x + 1) * kGuardBlock_px);
  const int y_end = std::min(image.height(), (block_y + 1) * kGuardBlock_px);
  for (int y = block_y * kGuardBlock_px; y < y_end; ++y)
    for (int x = block_x * kGuardBlock_px; x < x_end; ++x) {
      if (is_tested.at(x, y) == 0) continue;
      const float recorded = image.samples.at(x, y);
      const double single = other.at(x, y, image.ColourAt(x, y)) - recorded;
      const double joint = tested.at(x, y) - recorded;
      if (std::isnan(single) || std::isnan(joint)) continue;
      errors.single += single * single;
      errors.joint += joint * joint;
      ++errors.count;
    }
  return errors;
}

}  // namespace

GuardErrors& GuardErrors::operator+=(const GuardErrors& errors) {
  single += errors.single;
  joint += errors.joint;
  kept += errors.kept;
  count += errors.count;
  block_count += errors.block_count;
  joint_block_count += errors.joint_block_count;
  return *this;
}

Image<uint8_t> TestedPixels(uint64_t seed, int width, int height) {
  constexpr uint64_t kOneOf = 4;
  Image<uint8_t> result(width, height);
  uint64_t index = 0;
  for (uint8_t& is_tested : result.pixels())
    is_tested = RandomBits(kGuardSeed, seed, index++) % kOneOf == 0 ? 1 : 0;
  return result;
}

GuardErrors ApplyGuard(const JointImage& image, const Image<float>& other,
                       const Image<uint8_t>& is_tested, const Image<float>& tested,
                       Image<float>* joint) {
  const int columns = BlockCount(image.width()), rows = BlockCount(image.height());
  std::vector<GuardErrors> of_blocks;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      of_blocks.push_back(ErrorsOfBlock(image, other, is_tested, tested, x, y));
  const auto block_at = [&](int x, int y) -> const GuardErrors& {
    return of_blocks[static_cast<size_t>(y) * static_cast<size_t>(columns) +
                     static_cast<size_t>(x)];
  };
  GuardErrors errors;
  Image<float> shares(columns, rows);  // 1: the block takes colours of neighbours
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      double single = 0, joint_error = 0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, rows - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, columns - 1); ++i) {
          const double weight = (i == x ? 2 : 1) * (j == y ? 2 : 1);
          single += weight * block_at(i, j).single;
          joint_error += weight * block_at(i, j).joint;
        }
      const bool is_better = joint_error < kMostError * single;
      shares.at(x, y) = is_better ? 1 : 0;
      const GuardErrors& block = block_at(x, y);
      errors += block;
      errors.kept += is_better ? block.joint : block.single;
      ++errors.block_count;
      if (is_better) ++errors.joint_block_count;
    }
  if (errors.joint_block_count == errors.block_count) return errors;
  for (int y = 0; y < image.height(); ++y) {
    const Between down = BlocksAt(y, rows);
    for (int x = 0; x < image.width(); ++x) {
      const Between across = BlocksAt(x, columns);
      const auto in_row = [&](int row) {
        return (1 - across.share) * shares.at(across.before, row) +
               across.share * shares.at(across.after, row);
      };
      const float share = (1 - down.share) * in_row(down.before) + down.share * in_row(down.after);
      for (int c = 0; c < 3; ++c) {
        float& value = joint->at(x, y, c);
        const float single = image.rgb.at(x, y, c);
        value = share <= 0 ? single : single + share * (value - single);
      }
    }
  }
  return errors;
}

}  // namespace lf
