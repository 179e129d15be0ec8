// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/haar.h"

#include <utility>

// SynthesizeHaar() with SIMD vectors, compiled for every instruction set; the program chooses one
// at run time (Highway).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/pixels/codec/haar.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Computes two rows of 2 * count values each from `count` coefficients of each subband: kLowLow
// (`low`), kHighLow (`across`), kLowHigh (`down`) and kHighHigh (`both`).
void MergeHaarRows(const int32_t* low, const int32_t* across, const int32_t* down,
                   const int32_t* both, int count, int32_t* HWY_RESTRICT upper,
                   int32_t* HWY_RESTRICT lower) {
  const hn::ScalableTag<int32_t> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= count; x += lanes) {
    const auto a = hn::LoadU(d, low + x), h = hn::LoadU(d, across + x);
    const auto v = hn::LoadU(d, down + x), b = hn::LoadU(d, both + x);
    const auto a_up = hn::Add(a, v), h_up = hn::Add(h, b);
    const auto a_down = hn::Sub(a, v), h_down = hn::Sub(h, b);
    hn::StoreInterleaved2(hn::Add(a_up, h_up), hn::Sub(a_up, h_up), d, upper + 2 * x);
    hn::StoreInterleaved2(hn::Add(a_down, h_down), hn::Sub(a_down, h_down), d, lower + 2 * x);
  }
  for (; x < count; ++x) {
    const int32_t a_up = low[x] + down[x], h_up = across[x] + both[x];
    const int32_t a_down = low[x] - down[x], h_down = across[x] - both[x];
    upper[2 * x] = a_up + h_up;
    upper[2 * x + 1] = a_up - h_up;
    lower[2 * x] = a_down + h_down;
    lower[2 * x + 1] = a_down - h_down;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
namespace {

HWY_EXPORT(MergeHaarRows);

// Equations 2.20 and 2.21 of the thesis (haar.h), applied literally to two neighbours.
std::pair<int32_t, int32_t> Analyzed(int32_t x, int32_t y) { return {(x + y) / 2, (x - y) / 2}; }
std::pair<int32_t, int32_t> Synthesized(int32_t a, int32_t d) { return {a + d, a - d}; }

// The four values that are restored from one coefficient of each subband.
struct Quad {
  std::pair<int32_t, int32_t> upper, lower;
};
Quad QuadOf(int32_t low, int32_t across, int32_t down, int32_t both) {
  const auto [a_up, a_down] = Synthesized(low, down);
  const auto [h_up, h_down] = Synthesized(across, both);
  return {Synthesized(a_up, h_up), Synthesized(a_down, h_down)};
}

}  // namespace

void AnalyzeHaar(const int32_t* values, int width, int height,
                 const std::array<int32_t*, kBands>& bands) {
  const int low_width = LowCount(width), high_width = HighCount(width);
  // Returns the low or the high coefficient x of row y after the transform along the row.
  const auto across = [&](int x, int y, bool is_high) {
    const int32_t* const row = values + static_cast<size_t>(y) * width;
    if (2 * x + 1 == width) return row[2 * x];
    const auto [average, difference] = Analyzed(row[2 * x], row[2 * x + 1]);
    return is_high ? difference : average;
  };
  for (int y = 0; y < LowCount(height); ++y)
    for (const bool is_high : {false, true}) {
      const int count = is_high ? high_width : low_width;
      int32_t* const low = bands[is_high ? kHighLow : kLowLow] + static_cast<size_t>(y) * count;
      int32_t* const high = bands[is_high ? kHighHigh : kLowHigh] + static_cast<size_t>(y) * count;
      for (int x = 0; x < count; ++x) {
        const int32_t upper = across(x, 2 * y, is_high);
        if (2 * y + 1 == height) {
          low[x] = upper;
          continue;
        }
        const auto [average, difference] = Analyzed(upper, across(x, 2 * y + 1, is_high));
        low[x] = average;
        high[x] = difference;
      }
    }
}

void SynthesizeHaar(Transform transform, const std::array<const int32_t*, kBands>& bands, int width,
                    int height, int32_t* values) {
  const int low_width = LowCount(width), high_width = HighCount(width);
  for (int y = 0; y < LowCount(height); ++y) {
    const bool has_lower = 2 * y + 1 < height;
    const int32_t* const low = bands[kLowLow] + static_cast<size_t>(y) * low_width;
    const int32_t* const across = bands[kHighLow] + static_cast<size_t>(y) * high_width;
    const int32_t* const down = bands[kLowHigh] + static_cast<size_t>(y) * low_width;
    const int32_t* const both = bands[kHighHigh] + static_cast<size_t>(y) * high_width;
    int32_t* const upper = values + static_cast<size_t>(2 * y) * width;
    int32_t* const lower = upper + width;
    int x = 0;
    if (transform == Transform::kSimd && has_lower) {
      HWY_DYNAMIC_DISPATCH(MergeHaarRows)
      (low, across, down, both, high_width, upper, lower);
      x = high_width;
    }
    for (; x < low_width; ++x) {
      const bool has_right = x < high_width;
      const Quad quad = QuadOf(low[x], has_right ? across[x] : 0, has_lower ? down[x] : 0,
                               has_right && has_lower ? both[x] : 0);
      upper[2 * x] = quad.upper.first;
      if (has_right) upper[2 * x + 1] = quad.upper.second;
      if (!has_lower) continue;
      lower[2 * x] = quad.lower.first;
      if (has_right) lower[2 * x + 1] = quad.lower.second;
    }
  }
}

}  // namespace lf
#endif  // HWY_ONCE
