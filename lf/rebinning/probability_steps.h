// SPDX-License-Identifier: Apache-2.0
// The steps of both implementations of probability_map.h, in integers. Internal to rebinning.
//
// A plane has one value for each pixel, or for each 2 x 2 pixels of a mosaic. It continues beyond
// its borders with its outermost values.
//
//   grey     the values of GreyRows                                 [0, 65535]
//   across   (sum of taps * grey + 128) >> 8                        in units of 1 / 16
//   smooth   (sum of taps * across of the rows + 2048) >> 12        in units of 1 / 16
//   change   min(|left + right + above + below - 4 here| >> 4, 65535), of values of smooth
//   p        min((change * alpha >> 8) + xi, 65535)  where change >= beta, else 0
//
// If p itself is smoothed (second_sigma_px), it takes the place of grey, and the result is (smooth
// + 8) >> 4.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lf/core/image.h"
#include "lf/rebinning/probability_map.h"

namespace lf {

// Weights of a Gaussian at distances 0, 1, ... Their sum over both sides, with the weight at 0
// counted once, is kTapSum.
struct SmoothingTaps {
  static constexpr uint32_t kTapSum = 4096;
  std::vector<uint32_t> values;
  int radius() const { return static_cast<int>(values.size()) - 1; }
};
SmoothingTaps MakeTaps(double sigma_px);

// ProbabilityOptions as integers, in the units of the steps above.
struct ProbabilityParameters {
  SmoothingTaps taps;
  SmoothingTaps second_taps;
  uint32_t alpha = 0;  // in units of 1 / 256
  uint32_t beta = 0;
  uint32_t xi = 0;
};
ProbabilityParameters MakeParameters(const ProbabilityOptions& options, bool is_mosaic);

inline uint16_t ProbabilityOf(const ProbabilityParameters& parameters, int32_t laplacian) {
  const uint32_t change =
      std::min(static_cast<uint32_t>(laplacian < 0 ? -laplacian : laplacian) >> 4, 65535u);
  if (change < parameters.beta) return 0;
  return static_cast<uint16_t>(std::min((change * parameters.alpha >> 8) + parameters.xi, 65535u));
}

// The grey plane, in stored values: for each RGB pixel, the stored value of (R + 2 G + B) / 4; for
// each 2 x 2 pixels of a mosaic, the mean of the stored values of the two greens.
class GreyRows {
 public:
  // Refers to the pixels and to the table, which must outlive this object; `part` is the part of
  // the pixels to read.
  GreyRows(const LfPixels& pixels, const PixelRect& part,
           const std::vector<uint16_t>& stored_values);
  const PixelRect& plane() const { return plane_; }
  int width() const { return plane_.width(); }
  int height() const { return plane_.height(); }
  void Read(int y, uint16_t* out) const;  // writes row y to out[width]

 private:
  uint16_t GreenOfPair(int x, int y) const;

  const LfPixels& pixels_;
  const uint16_t* stored_;
  PixelRect plane_;  // in pixels of the LF image; of a mosaic, in squares of 2 x 2 pixels
};

// Writes p of the pixels of `rect`, copied from `of_plane`, the p of a grey plane with the
// rectangle `plane`. p of masked pixels is 0.
void SpreadOverPixels(const LfPixels& pixels, const PixelRect& rect, const PixelRect& plane,
                      const Image<uint16_t>& of_plane, Image<uint16_t>* p);

// ProbabilityPlane() computes p of a grey plane. SmoothedPlane() smooths a plane. Both calculate in
// integers.
void ProbabilityPlane(const ProbabilityParameters& parameters, const GreyRows& grey,
                      Image<uint16_t>* p);
void SmoothedPlane(const SmoothingTaps& taps, const Image<uint16_t>& grey, Image<uint16_t>* smooth);

}  // namespace lf
