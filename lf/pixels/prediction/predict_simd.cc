// SPDX-License-Identifier: Apache-2.0
// Predict() with SIMD vectors, compiled for every instruction set; the program chooses one at run
// time (Highway). Values of a row of pixels, all channels, are the lanes of vectors: 16-bit lanes
// for pixels of 8 bits, 32-bit lanes for pixels of 16 bits.
#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "lf/pixels/prediction/prediction_cell.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "lf/pixels/prediction/predict_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#ifndef LF_PIXELS_PREDICTION_PREDICT_SIMD_ONCE
#define LF_PIXELS_PREDICTION_PREDICT_SIMD_ONCE
namespace lf {
namespace {

constexpr int kMostLanes = 16;
constexpr int kMostCellSide = 1 << kMostBlockBits;
constexpr int kMostCellValues = kMostCellSide * kMostPredictedChannels;
constexpr int kPatchSide = kMostCellSide + kTaps - 1;
constexpr int kPatchStride = kPatchSide * kMostPredictedChannels + kMostLanes;

template <class Pixel>
using LaneOf = std::conditional_t<sizeof(Pixel) == 1, int16_t, int32_t>;

// Memory of a thread for one cell.
template <class Pixel>
struct CellScratch {
  using Lane = LaneOf<Pixel>;
  CellMotion motion;
  // Weighted sums of the values of the cell: [row][value], without gaps between rows.
  std::array<Lane, static_cast<size_t>(kMostCellSide) * kMostCellValues + kMostLanes> sums;
  // Windows of the lower block for each row, and of the right block and the left one for each value
  // of a row.
  std::array<Lane, kMostCellSide> window;
  std::array<Lane, kMostCellValues + kMostLanes> right, left;
  // Pixels of a patch of a reference image that is not inside the pixels of this.
  std::array<Pixel, static_cast<size_t>(kPatchSide) * kPatchStride + kMostLanes> patch;
  std::array<Pixel, kMostCellValues + kMostLanes> row;
};

// The pixels around a square or a cell that are interpolated.
template <class Pixel>
struct Patch {
  const Pixel* first = nullptr;  // the pixel of the first tap
  size_t stride = 0;
};

// Returns the patch whose first pixel is (x, y) of the reference image: in the reference image, or,
// if it is not inside, or vectors would read beyond its memory, copied to `copy`.
//   width, height  size of the patch
template <class Pixel>
Patch<Pixel> PatchAt(const ReferencePart<Pixel>& reference, int x, int y, int width, int height,
                     Pixel* copy) {
  const ImageView<const Pixel>& pixels = reference.pixels;
  const int channels = pixels.channels;
  const int part_x = x - reference.x_begin, part_y = y - reference.y_begin;
  if (part_x >= 0 && part_y >= 0 && part_x + width <= pixels.width &&
      part_y + height <= pixels.height) {
    const size_t begin = part_y * pixels.stride + static_cast<size_t>(part_x) * channels;
    const size_t end =
        begin + (height - 1) * pixels.stride + static_cast<size_t>(width) * channels + kMostLanes;
    if (end <= (pixels.height - 1) * pixels.stride + static_cast<size_t>(pixels.width) * channels)
      return {pixels.data + begin, pixels.stride};
  }
  for (int row = 0; row < height; ++row) {
    const int from_y = std::clamp(std::clamp(y + row, 0, reference.height - 1) - reference.y_begin,
                                  0, pixels.height - 1);
    const Pixel* const from = pixels.row(from_y);
    Pixel* const to = copy + static_cast<size_t>(row) * kPatchStride;
    for (int column = 0; column < width; ++column) {
      const int from_x = std::clamp(
          std::clamp(x + column, 0, reference.width - 1) - reference.x_begin, 0, pixels.width - 1);
      std::copy_n(from + static_cast<size_t>(from_x) * channels, channels, to + column * channels);
    }
  }
  return {copy, kPatchStride};
}

// A rectangle of a cell whose pixels have the same displacement.
struct Piece {
  int x = 0, y = 0;  // position in the cell
  int width = 0, height = 0;
};

}  // namespace
}  // namespace lf
#endif  // LF_PIXELS_PREDICTION_PREDICT_SIMD_ONCE

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Interpolates a piece and adds its values, weighted, to the sums of the cell.
template <class Pixel>
void AddPiece(const Patch<Pixel>& patch, const WarpedPosition& moved, const CellTerm& term,
              const Piece& piece, int block_bits, int channels, CellScratch<Pixel>* scratch) {
  using Lane = LaneOf<Pixel>;
  const hn::CappedTag<Lane, kMostLanes> d;
  const hn::Rebind<Pixel, decltype(d)> d_pixel;
  const size_t lanes = hn::Lanes(d);
  const Taps& taps_across = kTapsOfPhase[moved.x & (kPhases - 1)];
  const Taps& taps_down = kTapsOfPhase[moved.y & (kPhases - 1)];
  static_assert(kTaps == 4);
  const auto across_0 = hn::Set(d, taps_across[0]), across_1 = hn::Set(d, taps_across[1]);
  const auto across_2 = hn::Set(d, taps_across[2]), across_3 = hn::Set(d, taps_across[3]);
  constexpr int kDownBits = sizeof(Pixel) == 1 ? kTapBits : 0;
  const auto down = [&](int tap) {
    return hn::Set(d, static_cast<Lane>(taps_down[tap] * (1 << kDownBits)));
  };
  const auto down_0 = down(0), down_1 = down(1), down_2 = down(2), down_3 = down(3);
  const auto middle = hn::Set(d, static_cast<Lane>(sizeof(Pixel) == 1 ? 128 << kTapBits : 0));
  const auto half = hn::Set(d, static_cast<Lane>(sizeof(Pixel) == 1 ? 0 : 1 << (2 * kTapBits - 1)));
  const auto weighted = [&](auto left, auto right, int share_left, int share_right) HWY_ATTR {
    return hn::Add(hn::Mul(left, hn::Set(d, static_cast<Lane>(share_left))),
                   hn::Mul(right, hn::Set(d, static_cast<Lane>(share_right))));
  };
  const size_t values = static_cast<size_t>(piece.width) * channels;
  const size_t row_values = static_cast<size_t>(channels) << block_bits;
  const size_t first = static_cast<size_t>(piece.x) * channels;
  for (size_t x = 0; x < values; x += lanes) {
    // Lanes beyond the piece get no weight, so that they leave the sums of others as they are.
    const auto is_inside = hn::FirstN(d, values - x);
    const auto left = hn::IfThenElseZero(is_inside, hn::LoadU(d, scratch->left.data() + first + x));
    const auto right =
        hn::IfThenElseZero(is_inside, hn::LoadU(d, scratch->right.data() + first + x));
    const Pixel* from = patch.first + x;
    const auto next_row = [&]() HWY_ATTR {
      const auto value = [&](int tap) HWY_ATTR {
        return hn::PromoteTo(d, hn::LoadU(d_pixel, from + tap * channels));
      };
      // Sums are computed modulo the range of the lanes. The result is within it.
      const auto sum = hn::Add(hn::Add(hn::Mul(value(0), across_0), hn::Mul(value(1), across_1)),
                               hn::Add(hn::Mul(value(2), across_2), hn::Mul(value(3), across_3)));
      from += patch.stride;
      return hn::Sub(sum, middle);
    };
    auto row_0 = next_row(), row_1 = next_row(), row_2 = next_row();
    const auto upper = weighted(left, right, term.shares[0], term.shares[1]);
    const auto change = hn::Sub(weighted(left, right, term.shares[2], term.shares[3]), upper);
    const auto first_weight = hn::Mul(upper, hn::Set(d, Lane{kWindow}));
    Lane* sums = scratch->sums.data() + static_cast<size_t>(piece.y) * row_values + first + x;
    for (int y = 0; y < piece.height; ++y, sums += row_values) {
      const auto row_3 = next_row();
      const auto window = hn::Set(d, scratch->window[piece.y + y]);
      const auto weight = hn::Add(first_weight, hn::Mul(change, window));
      if constexpr (sizeof(Pixel) == 1) {
        const auto value = hn::Add(
            hn::Add(hn::MulFixedPoint15(row_0, down_0), hn::MulFixedPoint15(row_1, down_1)),
            hn::Add(hn::MulFixedPoint15(row_2, down_2), hn::MulFixedPoint15(row_3, down_3)));
        hn::StoreU(hn::Add(hn::LoadU(d, sums), hn::MulFixedPoint15(value, weight)), d, sums);
      } else {
        const auto sum = hn::Add(hn::Add(hn::Mul(row_0, down_0), hn::Mul(row_1, down_1)),
                                 hn::Add(hn::Mul(row_2, down_2), hn::Mul(row_3, down_3)));
        const auto value = hn::ShiftRight<2 * kTapBits>(hn::Add(sum, half));
        hn::StoreU(hn::Add(hn::LoadU(d, sums), hn::Mul(value, weight)), d, sums);
      }
      row_0 = row_1;
      row_1 = row_2;
      row_2 = row_3;
    }
  }
}

// Adds a term to the sums of a cell whose first pixel is (x, y), as far as `inside` needs it.
template <class Pixel>
void AddTerm(const PlaneWarp& warp, const ReferencePart<Pixel>& reference, const CellTerm& term,
             int x, int y, const PixelRect& inside, int block_bits, CellScratch<Pixel>* scratch) {
  SetMotion(warp, term.depth, x, y, block_bits, &scratch->motion);
  const int side = 1 << block_bits;
  const int step = scratch->motion.square;
  for (int piece_y = 0; piece_y < side; piece_y += step)
    for (int piece_x = 0; piece_x < side; piece_x += step) {
      const PixelRect needed =
          Intersection({x + piece_x, y + piece_y, x + piece_x + step, y + piece_y + step}, inside);
      if (needed.empty()) continue;
      const WarpedPosition& moved = scratch->motion.At(piece_x, piece_y);
      const Piece piece = {needed.x_begin - x, needed.y_begin - y, needed.width(), needed.height()};
      const Patch<Pixel> patch =
          PatchAt(reference, needed.x_begin + (moved.x >> kPhaseBits) - kTapsBefore,
                  needed.y_begin + (moved.y >> kPhaseBits) - kTapsBefore, piece.width + kTaps - 1,
                  piece.height + kTaps - 1, scratch->patch.data());
      AddPiece(patch, moved, term, piece, block_bits, reference.pixels.channels, scratch);
    }
}

// Writes the pixels `inside` of a cell whose first pixel is (x, y).
template <class Pixel>
void StoreCell(int x, int y, const PixelRect& inside, int block_bits, const PixelRect& rect,
               CellScratch<Pixel>* scratch, ImageView<Pixel> predicted) {
  using Lane = LaneOf<Pixel>;
  const hn::CappedTag<Lane, kMostLanes> d;
  const hn::Rebind<Pixel, decltype(d)> d_pixel;
  constexpr int kBits = sizeof(Pixel) == 1 ? 5 : kWeightBits;
  const auto half = hn::Set(d, static_cast<Lane>(1 << (kBits - 1)));
  const auto middle = hn::Set(d, static_cast<Lane>(sizeof(Pixel) == 1 ? 128 : 0));
  const size_t channels = predicted.channels;
  const size_t values = inside.width() * channels;
  for (int row = inside.y_begin; row < inside.y_end; ++row) {
    const Lane* const sums =
        scratch->sums.data() +
        ((static_cast<size_t>(row - y) << block_bits) + inside.x_begin - x) * channels;
    for (size_t i = 0; i < values; i += hn::Lanes(d)) {
      const auto rounded = hn::ShiftRight<kBits>(hn::Add(hn::LoadU(d, sums + i), half));
      hn::StoreU(hn::DemoteTo(d_pixel, hn::Add(rounded, middle)), d_pixel, scratch->row.data() + i);
    }
    std::memcpy(predicted.row(row - rect.y_begin) + (inside.x_begin - rect.x_begin) * channels,
                scratch->row.data(), values * sizeof(Pixel));
  }
}

template <class Pixel>
void PredictOf(const PredictionPlan& plan, std::span<const ReferencePart<Pixel>> references,
               const PixelRect& rect, ImageView<Pixel> predicted) {
  using Lane = LaneOf<Pixel>;
  static thread_local CellScratch<Pixel> scratch;
  const int bits = plan.blocks.block_bits, side = 1 << bits, channels = predicted.channels;
  for (int i = 0; i < side * channels; ++i) {
    scratch.right[i] = static_cast<Lane>(WindowOfNext(i / channels, bits));
    scratch.left[i] = static_cast<Lane>(kWindow - scratch.right[i]);
  }
  for (int i = 0; i < side; ++i) scratch.window[i] = static_cast<Lane>(WindowOfNext(i, bits));
  const size_t cell_values = static_cast<size_t>(side) * side * channels;
  for (int cell_y = (rect.y_begin + side / 2) >> bits; cell_y * side - side / 2 < rect.y_end;
       ++cell_y)
    for (int cell_x = (rect.x_begin + side / 2) >> bits; cell_x * side - side / 2 < rect.x_end;
         ++cell_x) {
      const int x = cell_x * side - side / 2, y = cell_y * side - side / 2;
      const PixelRect inside = Intersection({x, y, x + side, y + side}, rect);
      const CellTerms cell = TermsOfCell(plan.blocks, cell_x, cell_y);
      std::fill_n(scratch.sums.data(), cell_values, Lane{0});
      for (int i = 0; i < cell.count; ++i) {
        const CellTerm& term = cell.terms[i];
        const PixelRect reach = Intersection(Moved(ReachOf(term, side), x, y), inside);
        if (!reach.empty())
          AddTerm(plan.warps[term.reference], references[term.reference], term, x, y, reach, bits,
                  &scratch);
      }
      StoreCell(x, y, inside, bits, rect, &scratch, predicted);
    }
}

void Predict8(const PredictionPlan& plan, std::span<const ReferencePart<uint8_t>> references,
              const PixelRect& rect, ImageView<uint8_t> predicted) {
  PredictOf(plan, references, rect, predicted);
}
void Predict16(const PredictionPlan& plan, std::span<const ReferencePart<uint16_t>> references,
               const PixelRect& rect, ImageView<uint16_t> predicted) {
  PredictOf(plan, references, rect, predicted);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(Predict8);
HWY_EXPORT(Predict16);

template <>
void Predict(const PredictionPlan& plan, std::span<const ReferencePart<uint8_t>> references,
             const PixelRect& rect, ImageView<uint8_t> predicted) {
  HWY_DYNAMIC_DISPATCH(Predict8)(plan, references, rect, predicted);
}
template <>
void Predict(const PredictionPlan& plan, std::span<const ReferencePart<uint16_t>> references,
             const PixelRect& rect, ImageView<uint16_t> predicted) {
  HWY_DYNAMIC_DISPATCH(Predict16)(plan, references, rect, predicted);
}

}  // namespace lf
#endif  // HWY_ONCE
