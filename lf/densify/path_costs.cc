// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/path_costs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/densify/path_costs.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_ATTR uint16_t ExtendPath(const uint8_t* HWY_RESTRICT cost, const uint16_t* HWY_RESTRICT last,
                             uint16_t least, uint16_t small, uint16_t large, int stride,
                             uint16_t* HWY_RESTRICT next, uint16_t* HWY_RESTRICT sums) {
  const hn::ScalableTag<uint16_t> d;
  const hn::Rebind<uint8_t, decltype(d)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto before = hn::Set(d, least), step = hn::Set(d, small);
  const auto jump = hn::Set(d, static_cast<uint16_t>(least + large));
  auto found = hn::Set(d, uint16_t{65535});
  for (int j = 0; j < stride; j += lanes) {
    const auto beside = hn::Min(hn::LoadU(d, last + j - 1), hn::LoadU(d, last + j + 1));
    const auto best = hn::Min(hn::Min(hn::LoadU(d, last + j), jump), hn::Add(beside, step));
    const auto value = hn::Add(hn::PromoteTo(d, hn::LoadU(d8, cost + j)), hn::Sub(best, before));
    hn::StoreU(value, d, next + j);
    hn::StoreU(hn::Add(hn::LoadU(d, sums + j), value), d, sums + j);
    found = hn::Min(found, value);
  }
  return hn::GetLane(hn::MinOfLanes(d, found));
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(ExtendPath);

uint16_t ExtendPath(const uint8_t* cost, const uint16_t* last, uint16_t least, uint16_t small,
                    uint16_t large, int stride, uint16_t* next, uint16_t* sums) {
  return HWY_DYNAMIC_DISPATCH(ExtendPath)(cost, last, least, small, large, stride, next, sums);
}

}  // namespace lf
#endif  // HWY_ONCE
