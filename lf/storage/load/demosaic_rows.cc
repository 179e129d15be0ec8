// SPDX-License-Identifier: Apache-2.0
// Plain loops that compilers vectorise. Highway compiles them for several instruction sets, and the
// program chooses one of these versions at run time. All versions do the same operations of IEEE
// 754 in the same order, so that their results have the same bits.
#include "lf/storage/load/demosaic_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lf/storage/load/demosaic_arithmetic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/storage/load/demosaic_rows.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {

HWY_ATTR HWY_INLINE uint32_t LoadWord(const uint16_t* values) {
  uint32_t word = 0;
  std::memcpy(&word, values, sizeof(word));
  return word;
}
HWY_ATTR HWY_INLINE void StoreWord(uint32_t first, uint32_t second, uint16_t* out) {
  const uint32_t word = first | second << 16;
  std::memcpy(out, &word, sizeof(word));
}

HWY_ATTR HWY_INLINE float Root(uint32_t value, float pedestal, float factor) {
  const float x = (static_cast<float>(static_cast<int32_t>(value)) - pedestal) * factor +  //
                  kRootOffset;
  return std::copysign(std::sqrt(std::fabs(x)), x);
}

HWY_ATTR void RootRows(const uint16_t* mosaic, float pedestal, const std::array<float, 2>& factor,
                       int count, float* HWY_RESTRICT even, float* HWY_RESTRICT odd) {
  const float factor_even = factor[0], factor_odd = factor[1];
  for (int k = 0; k < count; ++k) {
    const uint32_t pair = LoadWord(mosaic + 2 * k);
    even[k] = Root(pair & 0xffff, pedestal, factor_even);
    odd[k] = Root(pair >> 16, pedestal, factor_odd);
  }
}

// The mean of four estimates, weighted by 1 / gradient. With a common denominator it takes one
// division. `share` multiplies the weights of the estimates 2 and 3.
HWY_ATTR HWY_INLINE float MeanOf(float v0, float v1, float v2, float v3, float d0, float d1,
                                 float d2, float d3, float share) {
  const float d01 = d0 * d1, d23 = d2 * d3;
  const float w0 = d1 * d23, w1 = d0 * d23, w2 = d3 * d01 * share, w3 = d2 * d01 * share;
  return ((w0 * v0 + w1 * v1) + (w2 * v2 + w3 * v3)) / ((w0 + w1) + (w2 + w3));
}

HWY_ATTR void GreenRow(const CrossRows& cross, int count, float* HWY_RESTRICT green) {
  const float* const c = cross.centre;
  const auto [w1, w2, w3] = cross.west;
  const auto [e1, e2, e3] = cross.east;
  const auto [n1, n2, n3] = cross.north;
  const auto [s1, s2, s3] = cross.south;
  for (int k = 0; k < count; ++k) {
    const float across = std::fabs(w1[k] - e1[k]) + kLeastGreenGradient;
    const float along = std::fabs(n1[k] - s1[k]) + kLeastGreenGradient;
    const float dw = c[k] - w2[k], de = c[k] - e2[k], dn = c[k] - n2[k], ds = c[k] - s2[k];
    const float mean = MeanOf(w1[k] + dw * 0.5f, e1[k] + de * 0.5f, n1[k] + dn * 0.5f,
                              s1[k] + ds * 0.5f, across + std::fabs(dw) + std::fabs(w1[k] - w3[k]),
                              across + std::fabs(de) + std::fabs(e1[k] - e3[k]),
                              along + std::fabs(dn) + std::fabs(n1[k] - n3[k]),
                              along + std::fabs(ds) + std::fabs(s1[k] - s3[k]), 1);
    const float least = std::min(std::min(w1[k], e1[k]), std::min(n1[k], s1[k]));
    const float most = std::max(std::max(w1[k], e1[k]), std::max(n1[k], s1[k]));
    green[k] = std::min(most, std::max(least, mean));
  }
}

HWY_ATTR void DetailRow(const std::array<const float*, 2>& colour,
                        const std::array<const float*, 2>& green, int count,
                        float* HWY_RESTRICT products, float* HWY_RESTRICT squares) {
  const auto [c, c_below] = colour;
  const auto [g, g_below] = green;
  for (int k = 0; k < count; ++k) {
    const float g_right = g[k + 1] - g[k], g_down = g_below[k] - g[k];
    products[k] = (c[k + 1] - c[k]) * g_right + (c_below[k] - c[k]) * g_down;
    squares[k] = g_right * g_right + g_down * g_down;
  }
}

HWY_ATTR HWY_INLINE void AddRows(const std::array<const float*, 5>& rows, int count,
                                 float* HWY_RESTRICT sums) {
  const auto [a, b, c, d, e] = rows;
  for (int k = 0; k < count; ++k)
    sums[k] = a[k - kWindowReach] + b[k - kWindowReach] + c[k - kWindowReach] +
              d[k - kWindowReach] + e[k - kWindowReach];
}

HWY_ATTR void GainRow(const std::array<const float*, 5>& products,
                      const std::array<const float*, 5>& squares, int count,
                      float* HWY_RESTRICT sums, float* HWY_RESTRICT gain) {
  const int wide_count = count + 2 * kWindowReach;
  AddRows(products, wide_count, sums);
  AddRows(squares, wide_count, sums + wide_count);
  const float* const p = sums;
  const float* const q = sums + wide_count;
  for (int k = 0; k < count; ++k) {
    const float product = p[k] + p[k + 1] + p[k + 2] + p[k + 3] + p[k + 4];
    const float square = q[k] + q[k + 1] + q[k + 2] + q[k + 3] + q[k + 4];
    const float of_detail = (product + kGainPrior) / (square + kGainPrior);
    gain[k] = std::min(kMostDetailGain, std::max(0.f, of_detail));
  }
}

template <bool kIsDiagonal>
HWY_ATTR HWY_INLINE void ColourRowBy(const NeighbourRows& neighbours, const float* green,
                                     const float* gain, int count, float* HWY_RESTRICT out) {
  const auto [c0, c1, c2, c3] = neighbours.colour;
  const auto [g0, g1, g2, g3] = neighbours.green;
  for (int k = 0; k < count; ++k) {
    const float across = kLeastGradient + 0.5f * std::fabs(c0[k] - c1[k]);
    const float along = kLeastGradient + 0.5f * std::fabs(c2[k] - c3[k]);
    const float g = green[k], of_detail = gain[k];
    const float d0 = g - g0[k], d1 = g - g1[k], d2 = g - g2[k], d3 = g - g3[k];
    out[k] =
        MeanOf(c0[k] + of_detail * d0, c1[k] + of_detail * d1,  //
               c2[k] + of_detail * d2, c3[k] + of_detail * d3,  //
               across + std::fabs(d0), across + std::fabs(d1),  //
               along + std::fabs(d2), along + std::fabs(d3), kIsDiagonal ? 1 : kInterpolatedShare);
  }
}

HWY_ATTR void ColourRow(const NeighbourRows& neighbours, const float* green, const float* gain,
                        bool is_diagonal, int count, float* out) {
  if (is_diagonal)
    ColourRowBy<true>(neighbours, green, gain, count, out);
  else
    ColourRowBy<false>(neighbours, green, gain, count, out);
}

HWY_ATTR HWY_INLINE uint32_t Level(float root, float inverse, float offset) {
  const float v = (root * std::fabs(root) - kRootOffset) * inverse + offset;
  return static_cast<uint32_t>(static_cast<int32_t>(std::min(65535.f, std::max(0.f, v))));
}

template <bool kCIsRed, bool kCIsEven>
HWY_ATTR HWY_INLINE void RgbRowBy(const RowColours& colours, int count,
                                  uint16_t* HWY_RESTRICT rgb) {
  const uint16_t* const mosaic = colours.mosaic;
  const float *const g_at_c = colours.g_at_c, *const d_at_c = colours.d_at_c;
  const float *const c_at_g = colours.c_at_g, *const d_at_g = colours.d_at_g;
  const float inverse_c = colours.inverse[kCIsRed ? 0 : 2], inverse_g = colours.inverse[1];
  const float inverse_d = colours.inverse[kCIsRed ? 2 : 0];
  const float offset = colours.pedestal + 0.5f;
  for (int k = 0; k < count; ++k) {
    const uint32_t pair = LoadWord(mosaic + 2 * k), even = pair & 0xffff, odd = pair >> 16;
    const uint32_t c_of_c = kCIsEven ? even : odd, g_of_g = kCIsEven ? odd : even;
    const uint32_t g_of_c = Level(g_at_c[k], inverse_g, offset);
    const uint32_t d_of_c = Level(d_at_c[k], inverse_d, offset);
    const uint32_t c_of_g = Level(c_at_g[k], inverse_c, offset);
    const uint32_t d_of_g = Level(d_at_g[k], inverse_d, offset);
    uint16_t* const at_c = rgb + 8 * k + (kCIsEven ? 0 : 4);
    uint16_t* const at_g = rgb + 8 * k + (kCIsEven ? 4 : 0);
    StoreWord(kCIsRed ? c_of_c : d_of_c, g_of_c, at_c);
    StoreWord(kCIsRed ? d_of_c : c_of_c, 1, at_c + 2);
    StoreWord(kCIsRed ? c_of_g : d_of_g, g_of_g, at_g);
    StoreWord(kCIsRed ? d_of_g : c_of_g, 1, at_g + 2);
  }
}

HWY_ATTR void RgbRow(const RowColours& colours, int count, uint16_t* rgb) {
  if (colours.c_is_red && colours.c_is_even)
    RgbRowBy<true, true>(colours, count, rgb);
  else if (colours.c_is_red)
    RgbRowBy<true, false>(colours, count, rgb);
  else if (colours.c_is_even)
    RgbRowBy<false, true>(colours, count, rgb);
  else
    RgbRowBy<false, false>(colours, count, rgb);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(RootRows);
HWY_EXPORT(GreenRow);
HWY_EXPORT(DetailRow);
HWY_EXPORT(GainRow);
HWY_EXPORT(ColourRow);
HWY_EXPORT(RgbRow);

void RootRows(const uint16_t* mosaic, float pedestal, const std::array<float, 2>& factor, int count,
              float* even, float* odd) {
  HWY_DYNAMIC_DISPATCH(RootRows)(mosaic, pedestal, factor, count, even, odd);
}
void GreenRow(const CrossRows& cross, int count, float* green) {
  HWY_DYNAMIC_DISPATCH(GreenRow)(cross, count, green);
}
void DetailRow(const std::array<const float*, 2>& colour, const std::array<const float*, 2>& green,
               int count, float* products, float* squares) {
  HWY_DYNAMIC_DISPATCH(DetailRow)(colour, green, count, products, squares);
}
void GainRow(const std::array<const float*, 5>& products,
             const std::array<const float*, 5>& squares, int count, float* sums, float* gain) {
  HWY_DYNAMIC_DISPATCH(GainRow)(products, squares, count, sums, gain);
}
void ColourRow(const NeighbourRows& neighbours, const float* green, const float* gain,
               bool is_diagonal, int count, float* out) {
  HWY_DYNAMIC_DISPATCH(ColourRow)(neighbours, green, gain, is_diagonal, count, out);
}
void RgbRow(const RowColours& colours, int count, uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(RgbRow)(colours, count, rgb);
}

}  // namespace lf
#endif
