// SPDX-License-Identifier: Apache-2.0
// Sizes of the components and subbands of a tile, and the bands in which its coefficients are
// coded. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "lf/pixels/codec/code_head.h"
#include "lf/pixels/codec/coefficient_coder.h"
#include "lf/pixels/codec/wavelet53.h"

namespace lf {

// Number of levels after which coefficients are doubled: IsDoubled().
inline constexpr int kMostDoublings = 1;

// Returns true if coefficients of level `depth` are doubled before the next level transforms them:
// the low subband, or all four subbands if level `depth` splits a mosaic. Levels are counted from
// the finest, which is 1; only level 1 can split a mosaic.
bool IsDoubled(const CodeHead& head, int depth);

// Returns the finest level that transforms components, as IsDoubled() counts levels. It is 2 for a
// mosaic, because level 1 splits the mosaic into its components.
int FirstDepth(const CodeHead& head);

// Width and height of a plane of pixels or coefficients.
struct PlaneExtent {
  int width = 0;
  int height = 0;
  size_t count() const { return static_cast<size_t>(width) * height; }
};

// Returns the size of a component of a tile.
PlaneExtent ComponentSize(const CodeHead& head, int component, PlaneExtent tile);

// Returns the size of the low subband of a component of this size after `levels` levels.
PlaneExtent LowSize(PlaneExtent size, int levels);

// Returns the number of coefficients in the three high subbands of a plane.
size_t DetailCount(PlaneExtent size);

// Returns the number of strips in which the bands of a resolution are coded, in all components of a
// tile.
int StripCountOf(const CodeHead& head, PlaneExtent tile, int resolution);

// Returns the rounding by which the coefficients of a resolution were quantised.
Rounding RoundingOf(const CodeHead& head, int resolution);

// Returns the index in CodeHead::steps of the step of a subband.
//   is_diagonal  true for kHighHigh
int StepIndex(const CodeHead& head, int component, int resolution, bool is_diagonal);

// Returns the band of an approximation.
template <class T>
CoefficientBand<T> ApproximationBand(PlaneExtent size, T* values) {
  return {values, size.width, size.height};
}

// Returns the bands of details, which follow each other in memory.
//   size     of the plane that was split into these bands
//   parents  details of the next coarser level; null if there are none
template <class T>
std::array<CoefficientBand<T>, 3> DetailBands(PlaneExtent size, T* values,
                                              const std::remove_const_t<T>* parents) {
  std::array<CoefficientBand<T>, 3> bands;
  const PlaneExtent coarser = LowSize(size, 1);
  size_t i = 0;
  for (const Band band : {kHighLow, kLowHigh, kHighHigh}) {
    CoefficientBand<T>& coded = bands[i++];
    coded.values = values;
    coded.width = BandWidth(band, size.width);
    coded.height = BandHeight(band, size.height);
    coded.kind = band == kHighLow   ? BandKind::kVertical
                 : band == kLowHigh ? BandKind::kHorizontal
                                    : BandKind::kEven;
    values += BandSize(band, size.width, size.height);
    if (parents == nullptr) continue;
    coded.parent = parents;
    coded.parent_width = BandWidth(band, coarser.width);
    coded.parent_height = BandHeight(band, coarser.height);
    parents += BandSize(band, coarser.width, coarser.height);
  }
  return bands;
}

}  // namespace lf
