// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "lf/collection/prefilter/mosaic_correction.h"
#include "lf/collection/prefilter/prefilter.h"
#include "lf/collection/prefilter/prefilter_rows.h"
#include "lf/core/check.h"

namespace lf {
namespace {

// Returns the value of a knot, times Prefilter::kOne; value(k) is the value of the pixel whose
// index is that of the knot plus k, and there(k) is true if this pixel exists and is not masked.
template <class There, class Value>
int64_t Filtered(const Prefilter& filter, const There& there, const Value& value) {
  const int64_t middle = filter.is_even ? (value(0) + value(1) + 1) >> 1 : value(0);
  int64_t sum = 0;
  const auto add = [&](int weight, int k) { sum += weight * (there(k) ? value(k) : middle); };
  for (int k = 0; k < filter.count; ++k) {
    const int weight = filter.weights[static_cast<size_t>(k)];
    add(weight, -k);
    if (filter.is_even)
      add(weight, 1 + k);
    else if (k > 0)
      add(weight, k);
  }
  return sum;
}

int64_t Rounded(int64_t value, int bits) { return (value + (int64_t{1} << (bits - 1))) >> bits; }

}  // namespace

uint16_t CorrectedReference(int strength, const LfPixels& pixels, int column, int row,
                            int channel) {
  const MosaicCorrection::Weights weights = CorrectionWeights(
      strength, pixels.recorded, pixels.rect.x_begin + column, pixels.rect.y_begin + row, channel);
  const int64_t value = pixels.radiance.at(column, row, channel);
  int64_t sum = 0;
  for (int y = row - MosaicCorrection::kReach_px; y <= row + MosaicCorrection::kReach_px; ++y)
    for (int x = column - MosaicCorrection::kReach_px; x <= column + MosaicCorrection::kReach_px;
         ++x) {
      if (x < 0 || x >= pixels.rect.width() || y < 0 || y >= pixels.rect.height()) continue;
      if (pixels.IsMasked(x, y)) continue;
      for (size_t k = 0; k < weights.size(); ++k)
        if (std::abs(x - column) == MosaicCorrection::kGroups[k][0] &&
            std::abs(y - row) == MosaicCorrection::kGroups[k][1])
          sum += weights[k] * (int64_t{pixels.radiance.at(x, y, channel)} - value);
    }
  return static_cast<uint16_t>(
      std::clamp<int64_t>(value + Rounded(sum, MosaicCorrection::kBits), 0, 65535));
}

void FilterPixelsReference(const Prefilter& filter, const LfPixels& pixels, LfPixels* out) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && out != &pixels);
  *out = LfPixels(KnotsOf(filter, pixels.rect), BayerPattern::kNone);
  out->recorded = pixels.recorded;
  out->any_masked = pixels.any_masked;
  const bool corrects = filter.correction > 0 && pixels.recorded != BayerPattern::kNone;
  const auto there = [&](int x, int y) {
    return x >= 0 && x < pixels.rect.width() && y >= 0 && y < pixels.rect.height() &&
           !pixels.IsMasked(x, y);
  };
  const auto row_there = [&](int x, int y) {
    return there(x, y) && (!filter.is_even || there(x + 1, y));
  };
  const auto corrected = [&](int x, int y, int c) -> int64_t {
    return corrects && there(x, y) ? CorrectedReference(filter.correction, pixels, x, y, c)
                                   : pixels.radiance.at(x, y, c);
  };
  const auto along_row = [&](int x, int y, int c) {
    return Rounded(Filtered(
                       filter, [&](int k) { return there(x + k, y); },
                       [&](int k) { return corrected(x + k, y, c); }),
                   Prefilter::kBits - kPrefilterFraction);
  };
  for (int y = 0; y < out->rect.height(); ++y)
    for (int x = 0; x < out->rect.width(); ++x) {
      if (!row_there(x, y) || (filter.is_even && !row_there(x, y + 1))) {
        out->Mask(x, y);
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        const int64_t value = Rounded(Filtered(
                                          filter, [&](int k) { return row_there(x, y + k); },
                                          [&](int k) { return along_row(x, y + k, c); }),
                                      Prefilter::kBits + kPrefilterFraction);
        out->radiance.at(x, y, c) = static_cast<uint16_t>(std::clamp<int64_t>(value, 0, 65535));
      }
    }
}

}  // namespace lf
