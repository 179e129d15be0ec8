// SPDX-License-Identifier: Apache-2.0
// The filter *mosaic*: for each colour, pixels that recorded this colour count more than pixels for
// which it was interpolated (doc/ray.md, "What is added"). It calculates in integers and single
// precision, so that results are bit-identical everywhere. Internal to collection.
//
// The share s of a pixel in a colour is kRecordedShare, or 1 if the colour was interpolated there.
//
// A ray interpolated between sixteen pixels p_ik, in rows i and columns k, mixes columns as in
// cubic_weights.h, but with the shares s_ik of the pixels:
//   column_k = round(sum_i d_i s_ik (p_ik - 2^15) / 2^10),   d = CubicTapsAt(down, 11)
//   S = sum_k c_k column_k,  D = sum_k c_k sum_i d_i s_ik,   c = CubicTapsAt(right, 11)
// The ray's value is 2^10 S / D + 2^15, rounded half up, clipped to 16 bits. The ray counts as
// D / 2^22 rays, rounded half up: from 1 to kRecordedShare, because the cubic weights of every
// second pixel of a row or column add up to a share from 0 to 1. All sums fit into 32 bits.
//
// A ray interpolated between four pixels lies `right` / 256 px to the right of the upper left one
// and `down` / 256 px below it. The bilinear weights a_x a_y of the pixels add up to 2^16, and each
// pixel gets
//   t = floor(a_x a_y s / 2^9).
// With D = sum t and S = sum t p, at most 2^10 and 2^26, the ray's value is S / D, rounded half
// up, and it counts as D / 2^7 rays, rounded half up.
//
// If the LF image was filtered by shares (Prefilter::by_shares), its values contain the shares
// already: the ray has the value that is interpolated between four or sixteen of them without
// shares, and it counts as MeanShareOf() rays.
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
inline constexpr int kShareBits = 7;  // D / 2^kShareBits is the count of a ray of four pixels

// Returns the share s of pixel (x, y) in colour `channel`, for an LF image whose mosaic had the
// pattern `recorded`. The pattern kNone means that all pixels recorded all colours.
inline uint32_t RecordedShareOf(BayerPattern recorded, int x, int y, int channel) {
  const bool is_recorded =
      recorded == BayerPattern::kNone || BayerChannel(recorded, x, y) == channel;
  return is_recorded ? kRecordedShare : 1;
}

// Returns the mean of RecordedShareOf() over 2 x 2 pixels, rounded half up.
inline uint32_t MeanShareOf(BayerPattern recorded, int channel) {
  uint32_t sum = 0;
  for (int i = 0; i < 4; ++i) sum += RecordedShareOf(recorded, i % 2, i / 2, channel);
  return (sum + 2) / 4;
}

// Returns the value of a ray of sixteen pixels, from S (`sum`) and D (`count`) as defined above.
inline uint32_t CubicMosaicValue(int32_t sum, int32_t count) {
  const float quotient = static_cast<float>(sum) / static_cast<float>(count);
  const float value = quotient * (1 << kMosaicColumnShift) + 32768.5F;
  return static_cast<uint32_t>(std::clamp(value, 0.0F, 65535.0F));
}

// Returns the value of a ray of four pixels, or of the mean of several rays: sum / count, rounded
// half up.
inline uint32_t SharedMean(uint32_t sum, uint32_t count) {
  return static_cast<uint32_t>(static_cast<float>(sum) / static_cast<float>(count) + 0.5F);
}

// Returns the count of an element's ray in one colour, if it is the mean of several rays: their
// mean count, rounded half up.
//   count  the sum of the counts of these rays in this colour
//   most   kRecordedShare times the number of these rays
inline uint32_t MeanCount(uint32_t count, uint32_t most) {
  return (count * kRecordedShare + most / 2) / most;
}

}  // namespace lf
