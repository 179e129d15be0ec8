// SPDX-License-Identifier: Apache-2.0
// Compiled for every instruction set from one source (Highway). All arithmetic is of integers, so
// that results are bit-identical. A vector holds one to four pixels of four lanes.
#include "lf/collection/prefilter/mosaic_correction_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "lf/collection/prefilter/mosaic_correction_rows.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Values = hn::CappedTag<int32_t, 16>;

HWY_ATTR void AddRows(const std::array<const uint16_t*, 5>& rows, size_t count,
                      const std::array<int32_t*, 3>& sums) {
  const Values d;
  const hn::Rebind<uint16_t, Values> d16;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto at = [&](size_t row)
                        HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(d16, rows[row] + i)); };
    hn::StoreU(at(2), d, sums[0] + i);
    hn::StoreU(hn::Add(at(1), at(3)), d, sums[1] + i);
    hn::StoreU(hn::Add(at(0), at(4)), d, sums[2] + i);
  }
}

HWY_ATTR void CorrectLanes(const LaneWeights& weights, const std::array<const int32_t*, 3>& sums,
                           size_t count, uint16_t* out) {
  const Values d;
  const hn::Rebind<uint16_t, Values> d16;
  constexpr ptrdiff_t kPixel = LfPixels::kRgbLanes;
  constexpr size_t kPeriod = 2 * LfPixels::kRgbLanes;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto middle = hn::LoadU(d, sums[0] + i);
    const auto twice = hn::Add(middle, middle), four_times = hn::Add(twice, twice);
    auto sum = hn::Set(d, 1 << (MosaicCorrection::kBits - 1));
    // Loads the row of sums `rows` beside the middle one, `columns` pixels further.
    const auto at = [&](size_t rows, ptrdiff_t columns)
                        HWY_ATTR { return hn::LoadU(d, sums[rows] + i + columns * kPixel); };
    const auto add = [&](size_t group, hn::Vec<Values> of_group, hn::Vec<Values> itself) HWY_ATTR {
      const auto weight = hn::LoadU(d, weights[group].data() + i % kPeriod);
      sum = hn::Add(sum, hn::Mul(weight, hn::Sub(of_group, itself)));
    };
    // The groups of MosaicCorrection::kGroups.
    add(0, hn::Add(at(0, -1), at(0, 1)), twice);
    add(1, hn::Add(at(0, -2), at(0, 2)), twice);
    add(2, at(1, 0), twice);
    add(3, hn::Add(at(1, -1), at(1, 1)), four_times);
    add(4, hn::Add(at(1, -2), at(1, 2)), four_times);
    add(5, at(2, 0), twice);
    add(6, hn::Add(at(2, -1), at(2, 1)), four_times);
    add(7, hn::Add(at(2, -2), at(2, 2)), four_times);
    const auto corrected = hn::Add(middle, hn::ShiftRight<MosaicCorrection::kBits>(sum));
    hn::StoreU(hn::DemoteTo(d16, corrected), d16, out + i);  // clips to 0..65535
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(AddRows);
HWY_EXPORT(CorrectLanes);

void AddRows(const std::array<const uint16_t*, 5>& rows, size_t count,
             const std::array<int32_t*, 3>& sums) {
  HWY_DYNAMIC_DISPATCH(AddRows)(rows, count, sums);
}

void CorrectLanes(const LaneWeights& weights, const std::array<const int32_t*, 3>& sums,
                  size_t count, uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(CorrectLanes)(weights, sums, count, out);
}

}  // namespace lf
#endif
