// SPDX-License-Identifier: Apache-2.0
// The two loops of FilterPixels(). Internal to this folder.
#pragma once

#include <cstdint>

#include "lf/collection/prefilter/prefilter.h"

namespace lf {

// Bits that values keep after the binary point between the two loops.
inline constexpr int kPrefilterFraction = 2;

// Filters a row of pixels along the row. A value of the result is 2^kPrefilterFraction times the
// filtered value; lane kRayLane is 2^kPrefilterFraction, or 0 if the pixel is masked.
//   row         pixels of the row; the pixels before and behind them count as masked
//   width       number of pixels
//   any_masked  true if a pixel of the row is masked
//   count       number of knots
void FilterAlongRow(const Prefilter& filter, const uint16_t* row, int width, bool any_masked,
                    int count, int32_t* out);

// Number of rows of knots that are best made by one call of FilterAlongColumns().
inline constexpr int kKnotRowsAtOnce = 4;

// Filters rows of knots along the columns.
//   rows         rows[k] is the result of FilterAlongRow() for row y + k of pixels, where y is the
//                first row of the knots; zeros stand for rows that do not exist
//   any_missing  true if a row does not exist or a pixel is masked
//   row_count    number of rows of knots
//   count        number of knots in a row
//   out          [row_count][count][LfPixels::kRgbLanes]
void FilterAlongColumns(const Prefilter& filter, const int32_t* const* rows, bool any_missing,
                        int row_count, int count, uint16_t* out);

// Returns the rectangle of the knots that FilterPixels() makes of the pixels in `rect`.
inline PixelRect KnotsOf(const Prefilter& filter, const PixelRect& rect) {
  const int less = filter.is_even ? 1 : 0;
  if (rect.width() <= less || rect.height() <= less) return {};
  return {rect.x_begin, rect.y_begin, rect.x_end - less, rect.y_end - less};
}

}  // namespace lf
