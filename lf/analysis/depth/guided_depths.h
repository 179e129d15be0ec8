// SPDX-License-Identifier: Apache-2.0
// Judges and mends the depths of a sweep by the colours of the elements. Internal to this folder.
//
// An element's *fellows* are the elements in a window around it that have its colour. Each counts
// by a weight that falls with the difference of the colours; all weights are integers, so that no
// order of sums changes a bit. A surface has about one depth and one colour in such a window, and
// the borders of surfaces are borders of colours.
#pragma once

#include <cstdint>

#include "lf/core/image.h"
#include "lf/core/parallel.h"

namespace lf {

// The results of SweepTile() for all elements of a frame.
struct SweptMap {
  SweptMap(int width, int height)
      : index(width, height, 1, -1.0f), confidence(width, height), roots(width, height, 3) {}
  Image<float> index;       // [height][width] of the distance, with a fraction; negative: none
  Image<float> confidence;  // [height][width] from 0 to 1
  Image<uint16_t> roots;    // [height][width][3] roots of light (lens_views.h)
};

struct GuideOptions {
  int radius = 6;  // elements; windows have 2 r + 1 elements across and down
  // Two depths are equal if their indices differ by at most this.
  float same_depth = 3;
  // Elements with at least this confidence, and more than 0, have a depth for MendDepths().
  float least_confidence = 0.5f;
  // Root of the light that is white on a display; colours are compared in shares of it.
  double white_root = 65535;
};

// Multiplies a confidence from 0.5 on by kDoubtful (plane_sweep.h), unless 55 % of the fellows of
// the element have an equal depth with such a confidence. Beside the border of a near surface, the
// window of a sweep has the texture of the border, although the element may belong to a surface
// without texture behind it: most of its fellows then have no depth. An element that mixes the
// light of the border and of that surface is doubted if it shows more of the latter.
void DoubtLonelyDepths(const GuideOptions& options, ThreadPool& pool, SweptMap* map);

// Gives elements the weighted median of the depths of their fellows: elements without a depth, if
// 55 % of their fellows have one that is equal to the median, and elements whose own depth is not
// equal to a median that so many have. Their confidence becomes the mean of the fellows that agree.
// Other elements stay as they are; edges stay sharp, because elements across them have other
// colours.
void MendDepths(const GuideOptions& options, ThreadPool& pool, SweptMap* map);

}  // namespace lf
