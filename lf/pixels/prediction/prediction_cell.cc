// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/prediction_cell.h"

#include <algorithm>
#include <cstdlib>

#include "lf/core/check.h"

namespace lf {
namespace {

// Returns true if all pixels have the same displacement. Then positions need not be computed for
// each corner of a cell: they differ by whole pixels.
bool IsShift(const PlaneWarp& warp) {
  constexpr int64_t kUnit = int64_t{1} << kWarpBits;
  const auto& [across, down, scale] = warp.far;
  return across[0] == kUnit && across[1] == 0 && down[0] == 0 && down[1] == kUnit &&
         scale[0] == 0 && scale[1] == 0 && scale[2] == kUnit && warp.step[2] == 0;
}

}  // namespace

CellTerms TermsOfCell(const BlockField& blocks, int cell_x, int cell_y) {
  CellTerms found;
  const auto column = [&](int cell) { return std::clamp(cell, 0, blocks.columns - 1); };
  const auto row = [&](int cell) {
    return static_cast<size_t>(std::clamp(cell, 0, blocks.rows - 1)) * blocks.columns;
  };
  const int left = column(cell_x - 1), right = column(cell_x);
  const size_t upper_row = row(cell_y - 1), lower_row = row(cell_y);
  const std::array<size_t, 4> corners = {upper_row + left, upper_row + right, lower_row + left,
                                         lower_row + right};
  std::array<bool, 4> is_done{};
  for (int first = 0; first < 4; ++first) {
    if (is_done[first]) continue;
    // The corners with the same depth have the same terms.
    const uint8_t depth = blocks.depths[corners[first]];
    const int begin = found.count;
    for (int corner = first; corner < 4; ++corner) {
      if (blocks.depths[corners[corner]] != depth) continue;
      is_done[corner] = true;
      const Shares& shares = kSharesOfMask[blocks.masks[corners[corner]]];
      for (int reference = 0; reference < kMostReferences; ++reference) {
        if (shares[reference] == 0) continue;
        int term = begin;
        while (term < found.count && found.terms[term].reference != reference) ++term;
        if (term == found.count) found.terms[found.count++] = {reference, depth, {}};
        found.terms[term].shares[corner] = shares[reference];
      }
    }
  }
  return found;
}

PixelRect ReachOf(const CellTerm& term, int side) {
  const auto [upper_left, upper_right, lower_left, lower_right] = term.shares;
  const int quarter = side / 4;
  return {upper_left + lower_left > 0 ? 0 : quarter, upper_left + upper_right > 0 ? 0 : quarter,
          upper_right + lower_right > 0 ? side : side - quarter,
          lower_left + lower_right > 0 ? side : side - quarter};
}

void SetMotion(const PlaneWarp& warp, int depth, int x, int y, int block_bits, CellMotion* motion) {
  const int side = 1 << block_bits;
  if (IsShift(warp)) {
    const WarpedPosition moved = Warped(warp, depth, 0, 0);
    // Farther positions would be limited at some pixels only.
    constexpr int32_t kMostMove = 1 << (14 + kPositionBits);
    if (std::max(std::abs(moved.x), std::abs(moved.y)) <= kMostMove) {
      constexpr int kBits = kPositionBits - kPhaseBits, kHalf = 1 << (kBits - 1);
      motion->square = side;
      motion->squares[0][0] = {(moved.x + kHalf) >> kBits, (moved.y + kHalf) >> kBits};
      return;
    }
  }
  const auto displacement = [&](int at_x, int at_y) -> WarpedPosition {
    const WarpedPosition position = Warped(warp, depth, at_x, at_y);
    return {position.x - at_x * (1 << kPositionBits), position.y - at_y * (1 << kPositionBits)};
  };
  const WarpedPosition upper_left = displacement(x, y), upper_right = displacement(x + side, y);
  const WarpedPosition lower_left = displacement(x, y + side);
  const WarpedPosition lower_right = displacement(x + side, y + side);
  const auto spread = [](int32_t a, int32_t b, int32_t c, int32_t d) {
    const auto [least, greatest] = std::minmax({a, b, c, d});
    return int64_t{greatest} - least;
  };
  const int64_t change = std::max(spread(upper_left.x, upper_right.x, lower_left.x, lower_right.x),
                                  spread(upper_left.y, upper_right.y, lower_left.y, lower_right.y));
  constexpr int64_t kMostChange = int64_t{1} << (kPositionBits - 3);  // within a square
  motion->square = side;
  while (motion->square > kLeastSquare && change * motion->square > kMostChange * side)
    motion->square /= 2;
  // The centre of a square is 2 q i + q - 1 half pixels from the first pixel of the cell.
  const int shift = 2 * (block_bits + 1) + kPositionBits - kPhaseBits;
  const int64_t whole = 2 * side, half = int64_t{1} << (shift - 1);
  for (int row = 0; row < side / motion->square; ++row)
    for (int column = 0; column < side / motion->square; ++column) {
      const int64_t across = motion->square * (2 * column + 1) - 1;
      const int64_t down = motion->square * (2 * row + 1) - 1;
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

PixelRect Moved(const PixelRect& rect, int x, int y) {
  return {rect.x_begin + x, rect.y_begin + y, rect.x_end + x, rect.y_end + y};
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
        const PixelRect reach = Intersection(Moved(ReachOf(term, side), x, y), rect);
        SetMotion(plan.warps[term.reference], term.depth, x, y, bits, &motion);
        const int step = motion.square;
        for (int square_y = 0; square_y < side; square_y += step)
          for (int square_x = 0; square_x < side; square_x += step) {
            const PixelRect inside = Intersection(
                {x + square_x, y + square_y, x + square_x + step, y + square_y + step}, reach);
            if (inside.empty()) continue;
            const WarpedPosition& moved = motion.At(square_x, square_y);
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
