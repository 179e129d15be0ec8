// SPDX-License-Identifier: Apache-2.0
// The formulas of doc/formats/lf_image.md, "Prediction", applied to one value at a time.
#include <algorithm>
#include <limits>

#include "lf/pixels/prediction/prediction_cell.h"

namespace lf {
namespace {

// Returns the value of a reference image at a pixel. Pixels beyond the image are those at its edge.
template <class Pixel>
int64_t ValueAt(const ReferencePart<Pixel>& reference, int x, int y, int channel) {
  const auto clipped = [](int at, int size, int begin, int count) {
    return std::clamp(std::clamp(at, 0, size - 1) - begin, 0, count - 1);
  };
  return reference.pixels.at(
      clipped(x, reference.width, reference.x_begin, reference.pixels.width),
      clipped(y, reference.height, reference.y_begin, reference.pixels.height), channel);
}

// Returns a * b / 2^15, rounded to the nearest, halves up.
int64_t FixedProduct(int64_t a, int64_t b) { return (a * b + (1 << 14)) >> 15; }

// Returns the interpolated value at a displaced pixel: the value less 128, with 6 fraction bits,
// for pixels of 8 bits; the value itself, rounded, for pixels of 16 bits.
template <class Pixel>
int64_t Interpolated(const ReferencePart<Pixel>& reference, int x, int y, int channel,
                     const WarpedPosition& moved) {
  const Taps& across = kTapsOfPhase[moved.x & (kPhases - 1)];
  const Taps& down = kTapsOfPhase[moved.y & (kPhases - 1)];
  int64_t sum = 0;
  for (int j = 0; j < kTaps; ++j) {
    int64_t row = 0;
    for (int i = 0; i < kTaps; ++i)
      row += across[i] * ValueAt(reference, x + (moved.x >> kPhaseBits) + i - kTapsBefore,
                                 y + (moved.y >> kPhaseBits) + j - kTapsBefore, channel);
    if constexpr (sizeof(Pixel) == 1)
      sum += FixedProduct(row - (128 << kTapBits), down[j] << kTapBits);
    else
      sum += row * down[j];
  }
  return sizeof(Pixel) == 1 ? sum : (sum + (1 << (2 * kTapBits - 1))) >> (2 * kTapBits);
}

// Returns the weight of a term at a pixel of a cell.
int64_t WeightAt(const CellTerm& term, int offset_x, int offset_y, int block_bits) {
  const int right = WindowOfNext(offset_x, block_bits), lower = WindowOfNext(offset_y, block_bits);
  const int left = kWindow - right, upper = kWindow - lower;
  return int64_t{upper} * (left * term.shares[0] + right * term.shares[1]) +
         int64_t{lower} * (left * term.shares[2] + right * term.shares[3]);
}

}  // namespace

template <class Pixel>
void PredictReference(const PredictionPlan& plan, std::span<const ReferencePart<Pixel>> references,
                      const PixelRect& rect, ImageView<Pixel> predicted) {
  const int bits = plan.blocks.block_bits, side = 1 << bits;
  CellMotion motion;
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const int cell_x = (x + side / 2) >> bits, cell_y = (y + side / 2) >> bits;
      const int x_begin = cell_x * side - side / 2, y_begin = cell_y * side - side / 2;
      const CellTerms cell = TermsOfCell(plan.blocks, cell_x, cell_y);
      std::array<int64_t, kMostPredictedChannels> sums{};
      for (int i = 0; i < cell.count; ++i) {
        const CellTerm& term = cell.terms[i];
        SetMotion(plan.warps[term.reference], term.depth, x_begin, y_begin, bits, &motion);
        const WarpedPosition& moved = motion.At(x - x_begin, y - y_begin);
        const int64_t weight = WeightAt(term, x - x_begin, y - y_begin, bits);
        for (int channel = 0; channel < predicted.channels; ++channel) {
          const int64_t value = Interpolated(references[term.reference], x, y, channel, moved);
          sums[channel] += sizeof(Pixel) == 1 ? FixedProduct(value, weight) : value * weight;
        }
      }
      for (int channel = 0; channel < predicted.channels; ++channel) {
        const int64_t value = sizeof(Pixel) == 1
                                  ? ((sums[channel] + 16) >> 5) + 128
                                  : (sums[channel] + (1 << (kWeightBits - 1))) >> kWeightBits;
        predicted.at(x - rect.x_begin, y - rect.y_begin, channel) =
            static_cast<Pixel>(std::clamp<int64_t>(value, 0, std::numeric_limits<Pixel>::max()));
      }
    }
}
template void PredictReference(const PredictionPlan&, std::span<const ReferencePart<uint8_t>>,
                               const PixelRect&, ImageView<uint8_t>);
template void PredictReference(const PredictionPlan&, std::span<const ReferencePart<uint16_t>>,
                               const PixelRect&, ImageView<uint16_t>);

}  // namespace lf
