// SPDX-License-Identifier: Apache-2.0
// Filters an LF image once, before rays are read from it, so that every ray may be interpolated
// linearly between only four values (doc/ray.md, "What is added").
//
// An element shows the mean light of its area, which is w x w LF pixels in the LF image. LF pixels
// and linear interpolation blur as well, and images made of pixels alias. PrefilterFor() finds the
// symmetric filter for which the expected squared error of an element is least. Along one axis, let
// S(f) be the spectrum of the scene (cycles per LF pixel), P(f) what an LF pixel lets through, H(f)
// the filter, and T(f) = sinc(f)^2 linear interpolation. The error is
//   integral of S ((P H T - sinc(w f))^2 + (P H)^2 A / N) df
// The first term is the difference of sharpness. A(f), the sum of T(f + j)^2 over all integers j
// other than 0, is the aliasing of interpolation. Its phase differs from LF image to LF image, so
// that its power is divided by N in the mean of N rays.
//
// The filtered values stand at knots: at the centres of pixels if the filter has an odd number of
// weights, as is best for elements about as wide as 1, 3, 5 ... LF pixels, otherwise midway between
// pixels. (Blu, Thevenaz and Unser, "Linear interpolation revitalized", IEEE Trans. Image
// Processing 2004, also shift the knots of linear interpolation and filter before it.)
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "lf/camera/magnification.h"
#include "lf/core/image.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// A filter that is applied along rows and along columns. Its integer weights add up to kOne.
struct Prefilter {
  static constexpr int kBits = 10;
  static constexpr int kOne = 1 << kBits;
  static constexpr int kMostWeights = 11;

  bool is_even = false;  // true: knots are midway between pixels
  int count = 1;         // number of different weights
  // The weights, times kOne, of the pixels at the distances 0, 1, 2 ... px on both sides of a knot;
  // 1/2, 3/2 ... px if is_even.
  std::array<int16_t, kMostWeights> weights = {kOne};
  // Strength of the correction that pixels made from a mosaic (LfPixels::recorded) get before they
  // are filtered: 0 (none) to kStrongestCorrection (mosaic_correction.h).
  int correction = 0;

  bool changes_nothing() const { return !is_even && count == 1 && correction == 0; }
  friend bool operator==(const Prefilter&, const Prefilter&) = default;
  friend auto operator<=>(const Prefilter&, const Prefilter&) = default;
};

// Returns the filter for elements that are `width_px` LF pixels wide. Rounds the width to
// sixteenths, so that frames of slightly different scale share filtered images. Elements of at most
// kFinerAtMost LF pixels are treated as if they were one LF pixel wide, and elements wider than
// kWidestElement_px as if they were that wide.
Prefilter PrefilterFor(double width_px, PixelFootprint footprint);

inline constexpr double kFinerAtMost = 1.25;

// Writes the filtered values to `out`, whose memory is reused: first along rows, rounded to
// quarters, then along columns, rounded half up and clipped to 0..65535. Pixel (x, y) of the result
// is the knot at the centre of pixel (x, y), or the one between (x, y) and (x + 1, y + 1) if
// filter.is_even; the result then has one column and one row less.
//
// The second step takes the values of the first as its pixels. In each step, a knot is masked if
// the pixel at it is masked or, if filter.is_even, one of the two pixels beside it along the
// filtered axis. Other pixels that are masked or not in `pixels` count as the pixel at the knot, or
// as the mean of the two beside it. If `pixels` is a part of the LF image, values that need pixels
// of the LF image beyond this part are wrong.
//   pixels  RGB; must not be *out. Opacities are left out
void FilterPixels(const Prefilter& filter, const LfPixels& pixels, LfPixels* out);

class RowFilter;

// Replaces pixels by what FilterPixels() makes of them, while their rows are still being written:
// each row is then read while it is in the caches.
class InPlaceFilter {
 public:
  // The pixels must outlive the object. Only their radiance may be incomplete; their opacity must
  // be empty (LfPixels::TakeOpacity()).
  InPlaceFilter(const Prefilter& filter, LfPixels* pixels);
  ~InPlaceFilter();

  // Must be called when the first `row_count` rows of the radiance are complete, as often as is
  // convenient. The call with all rows is the last one: it finishes the result.
  void Advance(int row_count);

 private:
  LfPixels& pixels_;
  const PixelRect knots_;
  std::unique_ptr<RowFilter> rows_;  // null: there are no knots
};

// Filters complete pixels in place. Their opacity must be empty.
inline void FilterInPlace(const Prefilter& filter, LfPixels* pixels) {
  InPlaceFilter(filter, pixels).Advance(pixels->radiance.height());
}

// Computes the values of FilterPixels() literally, one at a time.
void FilterPixelsReference(const Prefilter& filter, const LfPixels& pixels, LfPixels* out);

}  // namespace lf
