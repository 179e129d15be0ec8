// SPDX-License-Identifier: Apache-2.0
// Highway compiles these loops for several instruction sets, and the program chooses one of these
// versions at run time. All compute the same bits.
#include "lf/densify/matching_row.h"

#include <algorithm>
#include <cstring>

#include "lf/core/check.h"
#include "lf/densify/matching_costs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/densify/matching_row.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kChunk = 256;       // pixels that are compared at once
constexpr int kFractionBits = 5;  // positions between pixels, in steps of 1/32
constexpr int kOne = 1 << kFractionBits;
constexpr int32_t kOutside = -1;

// The places at which a view shows a chunk of pixels.
struct Places {
  alignas(64) int32_t pixel[kChunk];  // index of the upper left of four pixels, or kOutside
  alignas(64) int32_t right[kChunk];  // weight of the right two
  alignas(64) int32_t below[kChunk];  // weight of the lower two
};

HWY_ATTR void FindPlaces(const PairMap& map, float x_begin, float y, float z, int count,
                         const TonesView& view, Places* places) {
  const float* a = map.a;
  const float u0 = a[1] * y + a[2] + z * map.b[0];
  const float v0 = a[4] * y + a[5] + z * map.b[1];
  const float w0 = a[7] * y + a[8] + z * map.b[2];
  const float a0 = a[0], a3 = a[3], a6 = a[6];
  const auto last_u = static_cast<float>(view.width - 1),
             last_v = static_cast<float>(view.height - 1);
  const int32_t width = view.width;
  for (int i = 0; i < count; ++i) {
    const float x = x_begin + static_cast<float>(i);
    const float w = w0 + a6 * x;
    const float inverse = 1.0f / w;
    const float u = (u0 + a0 * x) * inverse - 0.5f;
    const float v = (v0 + a3 * x) * inverse - 0.5f;
    // Up to a pixel beyond the outermost centres, the border is continued.
    const bool is_inside =
        (w > 0.0f) & (u > -1.0f) & (v > -1.0f) & (u < last_u + 1.0f) & (v < last_v + 1.0f);
    const float near_u = std::min(std::max(u, 0.0f), last_u - 1.0f / 1024);
    const float near_v = std::min(std::max(v, 0.0f), last_v - 1.0f / 1024);
    const auto column = static_cast<int32_t>(near_u), row = static_cast<int32_t>(near_v);
    places->right[i] = static_cast<int32_t>((near_u - static_cast<float>(column)) * kOne);
    places->below[i] = static_cast<int32_t>((near_v - static_cast<float>(row)) * kOne);
    places->pixel[i] = is_inside ? row * width + column : kOutside;
  }
}

#if HWY_TARGET == HWY_SCALAR

HWY_ATTR HWY_INLINE uint64_t PixelAt(const uint16_t* tones) {
  uint64_t pixel = 0;
  std::memcpy(&pixel, tones, sizeof(pixel));
  return pixel;
}

// Interpolates the tones at each place. A pixel's four tones, each below 256, are four 16-bit
// fields of a word, which are computed at once; no field overflows into the next.
HWY_ATTR void Interpolate(const Places& places, int count, const TonesView& view,
                          uint64_t* HWY_RESTRICT samples) {
  constexpr uint64_t kThreeFractionBits = 0x07ff07ff07ff07ffULL;
  constexpr uint64_t kBytes = 0x00ff00ff00ff00ffULL;
  const size_t below_stride = static_cast<size_t>(view.width) * 4;
  for (int i = 0; i < count; ++i) {
    const size_t pixel = static_cast<size_t>(std::max(places.pixel[i], 0)) * 4;
    const uint16_t* above = view.data + pixel;
    const uint16_t* below = above + below_stride;
    const auto weight_below = static_cast<uint64_t>(places.below[i]);
    const auto weight_right = static_cast<uint64_t>(places.right[i]);
    const uint64_t left = PixelAt(above) * (kOne - weight_below) + PixelAt(below) * weight_below;
    const uint64_t right =
        PixelAt(above + 4) * (kOne - weight_below) + PixelAt(below + 4) * weight_below;
    const uint64_t sum = ((left >> 2) & kThreeFractionBits) * (kOne - weight_right) +
                         ((right >> 2) & kThreeFractionBits) * weight_right;
    samples[i] = (sum >> 8) & kBytes;
  }
}

// Writes the costs of samples: kPerTone times the sum of the absolute differences of tones. Four
// fields of a word are computed at once, as in Interpolate().
HWY_ATTR void CompareSamples(const uint64_t* HWY_RESTRICT samples,
                             const uint64_t* HWY_RESTRICT wanted, int count,
                             uint64_t* HWY_RESTRICT costs) {
  constexpr uint64_t kOnes = 0x0001000100010001ULL, kBytes = 0x00ff00ff00ff00ffULL;
  constexpr uint64_t kMost = MatchingCosts::kMostDifference, kPerTone = MatchingCosts::kPerTone;
  for (int i = 0; i < count; ++i) {
    // A field is 256 + a - b. Its bit 8 is 0 if a < b; its lower bits are then 256 - (b - a).
    const uint64_t difference = (samples[i] | kOnes << 8) - wanted[i];
    const uint64_t is_negative = (~difference >> 8) & kOnes;
    const uint64_t absolute =
        ((difference & kBytes) ^ ((is_negative << 8) - is_negative)) + is_negative;
    const uint64_t pairs = absolute + (absolute >> 32);
    const uint64_t sum = (pairs + (pairs >> 16)) & 0xffff;
    costs[i] = (sum < kMost ? sum : kMost) * kPerTone;
  }
}

#else

// Weights of two neighbouring pixels, for each lane of their eight tones.
struct Weights {
  alignas(16) uint16_t below[kOne][8];  // weights of the lower pixels
  alignas(16) uint16_t right[kOne][8];  // weights of the left pixel and the right one

  constexpr Weights() : below(), right() {
    for (int weight = 0; weight < kOne; ++weight)
      for (int lane = 0; lane < 8; ++lane) {
        below[weight][lane] = static_cast<uint16_t>(weight);
        right[weight][lane] = static_cast<uint16_t>(lane < 4 ? kOne - weight : weight);
      }
  }
};
constexpr Weights kWeights;

// Interpolates the tones at each place. Two neighbouring pixels of a row are one vector of eight
// 16-bit tones, each below 256.
HWY_ATTR void Interpolate(const Places& places, int count, const TonesView& view,
                          uint64_t* HWY_RESTRICT samples) {
  const hn::FixedTag<uint16_t, 8> d;
  const hn::Repartition<uint32_t, decltype(d)> d32;
  const hn::Repartition<uint64_t, decltype(d)> d64;
  const size_t below_stride = static_cast<size_t>(view.width) * 4;
  for (int i = 0; i < count; ++i) {
    const size_t pixel = static_cast<size_t>(std::max(places.pixel[i], 0)) * 4;
    const auto above = hn::LoadU(d, view.data + pixel);
    const auto below = hn::LoadU(d, view.data + pixel + below_stride);
    const auto weight_below = hn::Load(d, kWeights.below[places.below[i]]);
    // (1 - w) a + w b. The difference may be negative, but the sum is not, and has at most 13 bits.
    const auto columns = hn::ShiftRight<2>(
        hn::Add(hn::ShiftLeft<kFractionBits>(above), hn::Mul(hn::Sub(below, above), weight_below)));
    const auto parts = hn::Mul(columns, hn::Load(d, kWeights.right[places.right[i]]));
    const auto sum = hn::Add(parts, hn::BitCast(d, hn::Shuffle1032(hn::BitCast(d32, parts))));
    samples[i] = hn::GetLane(hn::BitCast(d64, hn::ShiftRight<8>(sum)));
  }
}

// Writes the costs of samples: kPerTone times the sum of the absolute differences of the tones.
HWY_ATTR void CompareSamples(const uint64_t* HWY_RESTRICT samples,
                             const uint64_t* HWY_RESTRICT wanted, int count,
                             uint64_t* HWY_RESTRICT costs) {
  const hn::ScalableTag<uint64_t> d;
  const hn::Repartition<uint8_t, decltype(d)> d8;
  const hn::Repartition<uint16_t, decltype(d)> d16;
  const auto most = hn::Set(d16, uint16_t{MatchingCosts::kMostDifference});
  const auto per_tone = hn::Set(d16, uint16_t{MatchingCosts::kPerTone});
  // Arrays have kChunk samples, so that the last vector may reach beyond `count`.
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto a = hn::BitCast(d8, hn::Load(d, samples + i));
    const auto b = hn::BitCast(d8, hn::Load(d, wanted + i));
    const auto sums = hn::SumsOf8(hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)));
    const auto scaled = hn::Mul(hn::Min(hn::BitCast(d16, sums), most), per_tone);
    hn::Store(hn::BitCast(d, scaled), d, costs + i);
  }
}

#endif

HWY_ATTR void CompareRow(const uint16_t* reference, int x_begin, int y, int count,
                         const PairMap& map, float z, const TonesView& view, uint16_t* costs) {
  constexpr uint16_t kUnseen = MatchingCosts::kMost * 7 / 12;
  Places places;
  alignas(64) uint64_t samples[kChunk], wanted[kChunk], sums[kChunk];
  for (int begin = 0; begin < count; begin += kChunk) {
    const int size = std::min(kChunk, count - begin);
    FindPlaces(map, static_cast<float>(x_begin + begin) + 0.5f, static_cast<float>(y) + 0.5f, z,
               size, view, &places);
    Interpolate(places, size, view, samples);
    std::memcpy(wanted, reference + static_cast<size_t>(begin) * 4,
                sizeof(uint64_t) * static_cast<size_t>(size));
    CompareSamples(samples, wanted, size, sums);
    for (int i = 0; i < size; ++i)
      costs[begin + i] = places.pixel[i] < 0 ? kUnseen : static_cast<uint16_t>(sums[i]);
  }
}

HWY_ATTR void MeanOfNine(const uint16_t* HWY_RESTRICT above, const uint16_t* HWY_RESTRICT middle,
                         const uint16_t* HWY_RESTRICT below, int count,
                         uint16_t* HWY_RESTRICT means) {
  for (int i = 0; i < count; ++i) {
    const auto left = static_cast<uint16_t>(above[i] + middle[i] + below[i]);
    const auto here = static_cast<uint16_t>(above[i + 1] + middle[i + 1] + below[i + 1]);
    const auto right = static_cast<uint16_t>(above[i + 2] + middle[i + 2] + below[i + 2]);
    // The sum is at most 9 * 240; 7282 / 65536 is 1/9, so that the mean of equal costs is exact.
    const auto sum = static_cast<uint32_t>(left + here + right);
    means[i] = static_cast<uint16_t>((sum * 7282) >> 16);
  }
}

HWY_ATTR void LeastOfGroups(const uint16_t* const* rows,
                            std::span<const std::span<const int>> groups, int count,
                            uint8_t* HWY_RESTRICT least) {
  alignas(64) uint16_t sums[kChunk], best[kChunk];
  for (int begin = 0; begin < count; begin += kChunk) {
    const int size = std::min(kChunk, count - begin);
    std::fill(best, best + size, uint16_t{MatchingCosts::kMost});
    for (const std::span<const int> group : groups) {
      std::fill(sums, sums + size, uint16_t{0});
      for (const int view : group) {
        const uint16_t* HWY_RESTRICT row = rows[view] + begin;
        for (int i = 0; i < size; ++i) sums[i] = static_cast<uint16_t>(sums[i] + row[i]);
      }
      const uint32_t share =
          (65536 + static_cast<uint32_t>(group.size()) - 1) / static_cast<uint32_t>(group.size());
      for (int i = 0; i < size; ++i)
        best[i] = std::min(best[i], static_cast<uint16_t>((sums[i] * share) >> 16));
    }
    for (int i = 0; i < size; ++i) least[begin + i] = static_cast<uint8_t>(best[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(CompareRow);
HWY_EXPORT(MeanOfNine);
HWY_EXPORT(LeastOfGroups);

void CompareRow(const uint16_t* reference, int x_begin, int y, int count, const PairMap& map,
                float z, const TonesView& view, uint16_t* costs) {
  LF_CHECK(view.width >= 2 && view.height >= 2);
  HWY_DYNAMIC_DISPATCH(CompareRow)(reference, x_begin, y, count, map, z, view, costs);
}

void MeanOfNine(const uint16_t* above, const uint16_t* middle, const uint16_t* below, int count,
                uint16_t* means) {
  HWY_DYNAMIC_DISPATCH(MeanOfNine)(above, middle, below, count, means);
}

void LeastOfGroups(const uint16_t* const* rows, std::span<const std::span<const int>> groups,
                   int count, uint8_t* least) {
  HWY_DYNAMIC_DISPATCH(LeastOfGroups)(rows, groups, count, least);
}

}  // namespace lf
#endif  // HWY_ONCE
