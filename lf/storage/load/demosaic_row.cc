// SPDX-License-Identifier: Apache-2.0
// The inner loop of demosaicing, a plain loop that compilers vectorise. Highway compiles it for
// several instruction sets, and the program chooses one of these versions at run time. The version
// for the baseline of x86-64 takes more than twice as long as those for newer instruction sets.
#include "lf/storage/load/demosaic_row.h"

#include <algorithm>
#include <cstring>

#include "lf/storage/load/demosaic_arithmetic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/storage/load/demosaic_row.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {

// Loads a pair of values into a 32-bit word, so that one lane of a vector holds a pair.
HWY_ATTR HWY_INLINE uint32_t Pair(const uint16_t* values) {
  uint32_t pair = 0;
  std::memcpy(&pair, values, sizeof(pair));
  return pair;
}
HWY_ATTR HWY_INLINE int32_t First(uint32_t pair) { return static_cast<int32_t>(pair & 0xffff); }
HWY_ATTR HWY_INLINE int32_t Second(uint32_t pair) { return static_cast<int32_t>(pair >> 16); }

HWY_ATTR HWY_INLINE void StoreWord(uint32_t first, uint32_t second, uint16_t* out) {
  const uint32_t word = first | second << 16;
  std::memcpy(out, &word, sizeof(word));
}

constexpr int kBits = kWeightBits + kRatioBits;

HWY_ATTR HWY_INLINE uint32_t Colour(int32_t sum) {
  return static_cast<uint32_t>(std::min(std::max((sum + (1 << (kBits - 1))) >> kBits, 0), 65535));
}

// In the names, c, g and d are the colours C, G and D of RowGains, "near" means the sum of the
// pixels above and below, and "left" and "right" are the pairs beside the pair `here`.
template <bool kCIsRed>
HWY_ATTR void DemosaicPairsBy(const uint16_t* const rows[5], const RowGains& gains, int pair_count,
                              uint16_t* HWY_RESTRICT rgb) {
  const uint16_t* HWY_RESTRICT top = rows[0];
  const uint16_t* HWY_RESTRICT upper = rows[1];
  const uint16_t* HWY_RESTRICT row = rows[2];
  const uint16_t* HWY_RESTRICT lower = rows[3];
  const uint16_t* HWY_RESTRICT bottom = rows[4];
  const RowGains gain = gains;
  for (int i = 0; i < 2 * pair_count; i += 2) {
    const uint32_t left = Pair(row + i - 2), here = Pair(row + i), right = Pair(row + i + 2);
    const uint32_t above = Pair(upper + i), below = Pair(lower + i);
    const uint32_t top_here = Pair(top + i), bottom_here = Pair(bottom + i);
    const int32_t c = First(here), g = Second(here), c_right = First(right), g_left = Second(left);
    const int32_t near_c = First(above) + First(below), near_g = Second(above) + Second(below);
    const int32_t near_g_left = Second(Pair(upper + i - 2)) + Second(Pair(lower + i - 2));
    const int32_t near_c_right = First(Pair(upper + i + 2)) + First(Pair(lower + i + 2));

    const int32_t laplacian_c =
        4 * c - (First(left) + c_right + First(top_here) + First(bottom_here));
    const uint32_t g_at_c = Colour(((g_left + g + near_c) << (kBits - 2)) +  //
                                   laplacian_c * gain.g_at_c);
    const uint32_t d_at_c = Colour(((near_g_left + near_g) << (kBits - 2)) +  //
                                   laplacian_c * gain.d_at_c);

    const int32_t g_beside = g_left + Second(right);
    const int32_t g_far = Second(top_here) + Second(bottom_here);
    const int32_t less_all = 2 * (5 * g - (near_c + near_c_right + g_beside + g_far));
    const uint32_t c_at_g = Colour(((c + c_right) << (kBits - 1)) +  //
                                   (less_all + 3 * g_far) * gain.c_at_g);
    const uint32_t d_at_g = Colour((near_g << (kBits - 1)) +  //
                                   (less_all + 3 * g_beside) * gain.d_at_g);

    const auto recorded_c = static_cast<uint32_t>(c), recorded_g = static_cast<uint32_t>(g);
    uint16_t* const out = rgb + 4 * i;
    StoreWord(kCIsRed ? recorded_c : d_at_c, g_at_c, out);
    StoreWord(kCIsRed ? d_at_c : recorded_c, 1, out + 2);
    StoreWord(kCIsRed ? c_at_g : d_at_g, recorded_g, out + 4);
    StoreWord(kCIsRed ? d_at_g : c_at_g, 1, out + 6);
  }
}

HWY_ATTR void DemosaicPairs(const uint16_t* const rows[5], bool c_is_red, const RowGains& gains,
                            int pair_count, uint16_t* rgb) {
  if (c_is_red)
    DemosaicPairsBy<true>(rows, gains, pair_count, rgb);
  else
    DemosaicPairsBy<false>(rows, gains, pair_count, rgb);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(DemosaicPairs);

void DemosaicPairs(const uint16_t* const rows[5], bool c_is_red, const RowGains& gains,
                   int pair_count, uint16_t* rgb) {
  HWY_DYNAMIC_DISPATCH(DemosaicPairs)(rows, c_is_red, gains, pair_count, rgb);
}

}  // namespace lf
#endif
