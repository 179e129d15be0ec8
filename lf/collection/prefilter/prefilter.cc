// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/prefilter/prefilter.h"

#include <algorithm>
#include <array>
#include <vector>

#include "lf/collection/prefilter/prefilter_rows.h"
#include "lf/core/check.h"

namespace lf {
namespace {

constexpr size_t kLanes = LfPixels::kRgbLanes;

// Does the first step of FilterPixels() for row `y` of pixels.
void FilterAlong(const Prefilter& filter, const LfPixels& pixels, int y, int count, int32_t* out) {
  const uint16_t* const row = pixels.radiance.row(y);
  const int width = pixels.radiance.width();
  if (!filter.by_shares || pixels.recorded == BayerPattern::kNone)
    return FilterAlongRow(filter, row, width, pixels.any_masked, count, out);
  std::array<int32_t, 2 * kLanes> factors;
  for (size_t i = 0; i < factors.size(); ++i) {
    const int x = static_cast<int>(i / kLanes), lane = static_cast<int>(i % kLanes);
    factors[i] = lane == LfPixels::kRayLane ? 256
                                            : ShareFactor(pixels.recorded, pixels.rect.x_begin + x,
                                                          pixels.rect.y_begin + y, lane);
  }
  thread_local std::vector<int32_t> weighed;
  weighed.resize(static_cast<size_t>(width) * kLanes);
  WeighRow(factors, row, width, weighed.data());
  FilterAlongWeighedRow(filter, weighed.data(), width, pixels.any_masked, count, out);
}

// Writes the knots of pixels to `knots`, row by row. `knots` may be the first value of `pixels`: a
// row of knots is written after all rows of pixels up to it were read.
//   to  rectangle of the knots
void FilterRows(const Prefilter& filter, const LfPixels& pixels, const PixelRect& to,
                uint16_t* knots) {
  const int width = pixels.radiance.width(), height = pixels.radiance.height();
  // The pixels from -before to +after of a row or a column make the value of knot 0.
  const int before = filter.count - 1, after = filter.is_even ? filter.count : before;
  const auto row_values = static_cast<size_t>(width) * kLanes;
  // A ring of the filtered rows that are still needed, and a row of zeros for missing rows.
  const auto ring = static_cast<size_t>(before + kKnotRowsAtOnce + after);
  thread_local std::vector<int32_t> filtered;
  filtered.resize((ring + 1) * row_values);
  std::fill(filtered.end() - static_cast<ptrdiff_t>(row_values), filtered.end(), 0);
  const auto at = [&](int y) {
    const size_t row = y < 0 || y >= height ? ring : static_cast<size_t>(y) % ring;
    return filtered.data() + row * row_values;
  };
  std::vector<const int32_t*> rows(ring);
  int next = 0, row_count = 0;
  for (int y = 0; y < to.height(); y += row_count) {
    row_count = std::min(kKnotRowsAtOnce, to.height() - y);
    const int end = y + row_count + after;
    for (; next < std::min(height, end); ++next)
      FilterAlong(filter, pixels, next, to.width(), at(next));
    for (int k = y - before; k < end; ++k) rows[static_cast<size_t>(k - y + before)] = at(k);
    const bool any_missing = pixels.any_masked || y < before || end > height;
    FilterAlongColumns(filter, rows.data() + before, any_missing, row_count, to.width(),
                       knots + static_cast<size_t>(y) * to.width() * kLanes);
  }
}

}  // namespace

void FilterPixels(const Prefilter& filter, const LfPixels& pixels, LfPixels* out) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone && out != &pixels);
  out->Reset(KnotsOf(filter, pixels.rect), BayerPattern::kNone);
  out->recorded = pixels.recorded;
  out->any_masked = pixels.any_masked;
  if (out->rect.empty()) return;
  FilterRows(filter, pixels, out->rect, out->radiance.row(0));
}

void FilterInPlace(const Prefilter& filter, LfPixels* pixels) {
  LF_CHECK(pixels->bayer == BayerPattern::kNone);
  const PixelRect knots = KnotsOf(filter, pixels->rect);
  Image<uint16_t>& radiance = pixels->radiance;
  if (!knots.empty()) FilterRows(filter, *pixels, knots, radiance.row(0));
  radiance.Resize(knots.width(), knots.height(), LfPixels::kRgbLanes);
  pixels->rect = knots;
}

}  // namespace lf
