// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/prediction_cell.h"

#include <algorithm>
#include <bit>

#include "lf/core/check.h"

namespace lf {

CellTerms TermsOfCell(const BlockField& blocks, int cell_x, int cell_y) {
  CellTerms found;
  for (int corner = 0; corner < 4; ++corner) {
    const int column = std::clamp(cell_x - 1 + corner % 2, 0, blocks.columns - 1);
    const int row = std::clamp(cell_y - 1 + corner / 2, 0, blocks.rows - 1);
    const size_t block = static_cast<size_t>(row) * blocks.columns + column;
    const int depth = blocks.depths[block];
    const unsigned mask = blocks.masks[block];
    const int count = std::popcount(mask);
    int rank = 0;
    for (int reference = 0; reference < kMostReferences; ++reference) {
      if ((mask >> reference & 1) == 0) continue;
      const auto end = found.terms.begin() + found.count;
      auto term = std::find_if(found.terms.begin(), end, [&](const CellTerm& other) {
        return other.reference == reference && other.depth == depth;
      });
      if (term == end) {
        *term = {reference, depth, {}};
        ++found.count;
      }
      term->shares[corner] = ShareOf(count, rank++);
    }
  }
  return found;
}

void SetMotion(const PlaneWarp& warp, int depth, int x, int y, int block_bits, CellMotion* motion) {
  const int side = 1 << block_bits;
  const auto displacement = [&](int at_x, int at_y) -> WarpedPosition {
    const WarpedPosition position = Warped(warp, depth, at_x, at_y);
    return {position.x - at_x * (1 << kPositionBits), position.y - at_y * (1 << kPositionBits)};
  };
  const WarpedPosition upper_left = displacement(x, y), upper_right = displacement(x + side, y);
  const WarpedPosition lower_left = displacement(x, y + side);
  const WarpedPosition lower_right = displacement(x + side, y + side);
  motion->is_uniform =
      upper_left == upper_right && upper_left == lower_left && upper_left == lower_right;
  const int squares = motion->is_uniform ? 1 : side / kSquare;
  // The centre of a square is 2 (4 i + 3 / 2) = 8 i + 3 half pixels from the first pixel.
  const int shift = 2 * (block_bits + 1) + kPositionBits - kPhaseBits;
  const int64_t whole = 2 * side, half = int64_t{1} << (shift - 1);
  for (int row = 0; row < squares; ++row)
    for (int column = 0; column < squares; ++column) {
      const int64_t across = 2 * kSquare * column + kSquare - 1,
                    down = 2 * kSquare * row + kSquare - 1;
      const auto between = [&](int64_t a, int64_t b, int64_t c, int64_t d) {
        const int64_t upper = a * (whole - across) + b * across;
        const int64_t lower = c * (whole - across) + d * across;
        return static_cast<int32_t>((upper * (whole - down) + lower * down + half) >> shift);
      };
      motion->squares[row][column] = {
          between(upper_left.x, upper_right.x, lower_left.x, lower_right.x),
          between(upper_left.y, upper_right.y, lower_left.y, lower_right.y)};
    }
}

BlockField MakeBlockField(int width, int height, int block_bits, uint8_t mask) {
  LF_CHECK(block_bits >= kLeastBlockBits && block_bits <= kMostBlockBits);
  const auto blocks_along = [block_bits](int size) {
    return (size + (1 << block_bits) - 1) >> block_bits;
  };
  BlockField blocks{block_bits, blocks_along(width), blocks_along(height), {}, {}};
  const size_t count = static_cast<size_t>(blocks.columns) * blocks.rows;
  blocks.depths.assign(count, 0);
  blocks.masks.assign(count, mask);
  return blocks;
}

std::vector<PixelRect> NeededOfReferences(const PredictionPlan& plan,
                                          std::span<const ReferenceSize> sizes,
                                          const PixelRect& rect) {
  std::vector<PixelRect> needed(plan.warps.size());
  const int bits = plan.blocks.block_bits, side = 1 << bits;
  CellMotion motion;
  for (int cell_y = (rect.y_begin + side / 2) >> bits; cell_y * side - side / 2 < rect.y_end;
       ++cell_y)
    for (int cell_x = (rect.x_begin + side / 2) >> bits; cell_x * side - side / 2 < rect.x_end;
         ++cell_x) {
      const int x = cell_x * side - side / 2, y = cell_y * side - side / 2;
      const CellTerms cell = TermsOfCell(plan.blocks, cell_x, cell_y);
      for (int i = 0; i < cell.count; ++i) {
        const CellTerm& term = cell.terms[i];
        SetMotion(plan.warps[term.reference], term.depth, x, y, bits, &motion);
        const int step = motion.is_uniform ? side : kSquare;
        for (int square_y = 0; square_y < side; square_y += step)
          for (int square_x = 0; square_x < side; square_x += step) {
            const PixelRect inside = Intersection(
                {x + square_x, y + square_y, x + square_x + step, y + square_y + step}, rect);
            if (inside.empty()) continue;
            const WarpedPosition& moved = motion.squares[square_y / kSquare][square_x / kSquare];
            // Positions beyond the image are those of its nearest pixels.
            const auto along = [](int begin, int end, int32_t displacement, int size) {
              const int first = begin + (displacement >> kPhaseBits) - kTapsBefore;
              const int last = end - 1 + (displacement >> kPhaseBits) + kTaps - 1 - kTapsBefore;
              return std::array{std::clamp(first, 0, size - 1), std::clamp(last, 0, size - 1) + 1};
            };
            const ReferenceSize& size = sizes[term.reference];
            const auto across = along(inside.x_begin, inside.x_end, moved.x, size.width);
            const auto down = along(inside.y_begin, inside.y_end, moved.y, size.height);
            needed[term.reference] =
                Bounds(needed[term.reference], {across[0], down[0], across[1], down[1]});
          }
      }
    }
  return needed;
}

}  // namespace lf
