// SPDX-License-Identifier: Apache-2.0
// Measures how far a picture is from a reference, for people who judge renders.
#pragma once

#include <cstdint>
#include <optional>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/compare/flip.h"
#include "lf/film/compare/picture_light.h"

namespace lf {

struct CompareOptions {
  int border = 0;  // pixels at each side that do not count, >= 0
  // Pixels count only where both pictures have at least this coverage; a picture without the
  // channel has the coverage 1 everywhere.
  double min_coverage = 0;
  double pixels_per_degree = kPixelsPerDegree;
};

// Sums over the pixels that count. The sums of several pictures may be added.
struct PictureDifference {
  int64_t pixel_count = 0;
  int64_t undefined_count = 0;  // pixels left out because a value is not a number or infinite
  double linear_squares = 0;    // squared differences of linear light, over all channels
  double display_squares = 0;   // squared differences of sRGB values, clipped to [0, 1]
  double ssim_sum = 0;
  double flip_sum = 0;

  PictureDifference& operator+=(const PictureDifference& other);

  // PSNR in dB over all channels, with the peak 1: of sRGB values, as people see and most tables
  // state, and of linear light. Infinite if all values are equal.
  double PsnrDb() const;
  double LinearPsnrDb() const;
  // Mean of the structural similarity of the brightness of sRGB values, 0.2126 R + 0.7152 G +
  // 0.0722 B (film/compare/ssim.h).
  double Ssim() const { return ssim_sum / static_cast<double>(pixel_count); }
  // Mean of FLIP (film/compare/flip.h).
  double Flip() const { return flip_sum / static_cast<double>(pixel_count); }
};

struct PictureComparison {
  PictureDifference difference;
  Image<float> flip;  // [height][width][1], also where pixels do not count
};

// Compares two pictures. Undefined values count as black in the windows of their neighbours. The
// result does not depend on the number of threads. kInput: the sizes differ, or no pixel counts;
// the message does not name the files.
Result<PictureComparison> ComparePictures(const PictureLight& reference, const PictureLight& test,
                                          const CompareOptions& options, ThreadPool& pool);

}  // namespace lf
