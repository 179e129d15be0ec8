// The filter *mosaic*: of the pixels around, those that recorded a colour count more for it than
// those whose colour was interpolated (doc/ray.md, "What is added"). In integers and single
// precision, so that the same bits come out everywhere. Internal to collection.
//
// k = kRecordedShare, or 1 where the colour was interpolated.
//
// Of sixteen pixels, the columns are mixed as those of cubic_weights.h, but with shares,
//   column_k = round(sum_i d_i k_ik (p_ik - 2^15) / 2^10),   d = CubicTapsAt(down, 11)
//   S = sum_k c_k column_k,  D = sum_k c_k sum_i d_i k_ik,   c = CubicTapsAt(right, 11)
// and the ray's value is 2^10 S / D + 2^15, rounded half up, clipped to 16 bits. It counts as
// D / 2^22 rays, rounded half up: from 1 to kRecordedShare, for the taps of every second pixel make
// something from 0 to 1. 32 bits hold all of it.
//
// Of four, at `right` and `down` / 256 from the upper left one, each has a weight a_x a_y of 2^16,
// and
//   t = floor(a_x a_y k / 2^9).
// With D = sum t and S = sum t p, at most 2^10 and 2^26, the ray's value is S / D, rounded half
// up, and it counts as D / 2^7 rays, rounded half up.
#pragma once

#include <algorithm>
#include <cstdint>

#include "lf/core/image.h"

namespace lf {

inline constexpr uint32_t kRecordedShare = 8;

inline constexpr int kMosaicTapBits = 11;
inline constexpr int kMosaicColumnShift = 10;
inline constexpr int kMosaicCountBits = 2 * kMosaicTapBits;

inline constexpr int kShareShift = 9;
inline constexpr int kShareBits = 7;  // of what a ray of four pixels counts for one

// k of colour `channel` at pixel (x, y) of an LF image whose mosaic had this pattern; kNone: all
// colours were recorded everywhere.
inline uint32_t RecordedShareOf(BayerPattern recorded, int x, int y, int channel) {
  const bool is_recorded =
      recorded == BayerPattern::kNone || BayerChannel(recorded, x, y) == channel;
  return is_recorded ? kRecordedShare : 1;
}

// The value of a ray of sixteen pixels.
inline uint32_t CubicMosaicValue(int32_t sum, int32_t count) {
  const float quotient = static_cast<float>(sum) / static_cast<float>(count);
  const float value = quotient * (1 << kMosaicColumnShift) + 32768.5F;
  return static_cast<uint32_t>(std::clamp(value, 0.0F, 65535.0F));
}

// The value of a ray of four, or of several: sum / count.
inline uint32_t SharedMean(uint32_t sum, uint32_t count) {
  return static_cast<uint32_t>(static_cast<float>(sum) / static_cast<float>(count) + 0.5F);
}

// What an element counts in a colour: the mean of the rays that it is made of, rounded half up.
//   count  of all of them in this colour
//   most   kRecordedShare for each
inline uint32_t MeanCount(uint32_t count, uint32_t most) {
  return (count * kRecordedShare + most / 2) / most;
}

}  // namespace lf
