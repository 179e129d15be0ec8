// SPDX-License-Identifier: Apache-2.0
// FindSeenCells(), compiled for every instruction set; the program chooses one at run time
// (Highway).
//
// Products and sums are never fused, so results are bit-identical on every instruction set.
#include "lf/core/check.h"
#include "lf/rebinning/frame_view.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/rebinning/frame_view_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

// Returns number `axis` of each key as a double: puts its 16 bits into the lowest bits of 2^52, and
// subtracts 2^52.
HWY_INLINE V NumberOf(const uint64_t* HWY_RESTRICT keys, int axis) {
  const D d;
  const hn::RebindToUnsigned<D> d64;
  const auto bits =
      hn::And(hn::ShiftRightSame(hn::Load(d64, keys), 16 * axis), hn::Set(d64, uint64_t{0xffff}));
  const V two_to_52 = hn::Set(d, 4503599627370496.0);
  return hn::Sub(hn::BitCast(d, hn::Or(bits, hn::BitCast(d64, two_to_52))), two_to_52);
}

HWY_INLINE V At(const CellForm& form, V a, V b) {
  const D d;
  return hn::Add(hn::Add(hn::Set(d, form.constant), hn::Mul(hn::Set(d, form.of_a), a)),
                 hn::Mul(hn::Set(d, form.of_b), b));
}

HWY_INLINE V Cross(V a, V b, V c, V d) { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); }

void FindSeen(const FrameView& view, std::span<const BinnedCell> cells, SeenCells* seen) {
  const D d;
  constexpr size_t kAtOnce = SeenCells::kAtOnce;
  const size_t lanes = hn::Lanes(d);
  HWY_ALIGN uint64_t keys[kAtOnce];
  for (size_t i = 0; i < cells.size(); ++i) keys[i] = cells[i].cell;
  for (size_t i = cells.size(); i < kAtOnce; ++i) keys[i] = 0;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  seen->count = 0;
  for (size_t begin = 0; begin < cells.size(); begin += lanes) {
    const V s = NumberOf(keys + begin, 0), t = NumberOf(keys + begin, 1);
    const V u = NumberOf(keys + begin, 2), v = NumberOf(keys + begin, 3);
    const V forward_st = At(view.st.forward, s, t), forward_uv = At(view.uv.forward, u, v);
    const V along = hn::Sub(forward_uv, forward_st);
    const V per_along = hn::Div(one, along);
    const V lens_x = hn::Mul(
        Cross(At(view.st.right, s, t), forward_uv, At(view.uv.right, u, v), forward_st), per_along);
    const V lens_y = hn::Mul(
        Cross(At(view.st.up, s, t), forward_uv, At(view.uv.up, u, v), forward_st), per_along);
    const V off2 = hn::Add(hn::Mul(lens_x, lens_x), hn::Mul(lens_y, lens_y));
    auto is_seen = hn::And(hn::Gt(along, zero), hn::Le(off2, hn::Set(d, view.lens_reach2_w2)));
    if (hn::AllFalse(d, is_seen)) continue;
    const V focus_st = At(view.st.focus, s, t), focus_uv = At(view.uv.focus, u, v);
    // X is the point where the ray meets the focus plane. `depth` is (forward . X) times `slope`.
    const V slope = hn::Sub(focus_uv, focus_st);
    const V depth = Cross(forward_st, focus_uv, forward_uv, focus_st);
    const V per_depth = hn::Div(one, depth);
    const V x = hn::Mul(
        Cross(At(view.st.plate_x, s, t), focus_uv, At(view.uv.plate_x, u, v), focus_st), per_depth);
    const V y = hn::Mul(
        Cross(At(view.st.plate_y, s, t), focus_uv, At(view.uv.plate_y, u, v), focus_st), per_depth);
    const auto is_between = [&](V value, double low, double high) {
      return hn::And(hn::Ge(value, hn::Set(d, low)), hn::Le(value, hn::Set(d, high)));
    };
    is_seen = hn::And(is_seen, hn::Gt(hn::Mul(depth, slope), zero));
    is_seen = hn::And(is_seen, is_between(x, view.plate_low_px[0], view.plate_high_px[0]));
    is_seen = hn::And(is_seen, is_between(y, view.plate_low_px[1], view.plate_high_px[1]));
    if (hn::AllFalse(d, is_seen)) continue;
    HWY_ALIGN double values[4][8], marks[8];
    hn::Store(lens_x, d, values[0]);
    hn::Store(lens_y, d, values[1]);
    hn::Store(x, d, values[2]);
    hn::Store(y, d, values[3]);
    hn::Store(hn::IfThenElseZero(is_seen, one), d, marks);
    for (size_t i = 0; i < lanes && begin + i < cells.size(); ++i) {
      if (marks[i] == 0) continue;
      seen->cells[seen->count] = begin + i;
      seen->lens_x_w[seen->count] = values[0][i];
      seen->lens_y_w[seen->count] = values[1][i];
      seen->x_px[seen->count] = values[2][i];
      seen->y_px[seen->count++] = values[3][i];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(FindSeen);

void FindSeenCells(const FrameView& view, std::span<const BinnedCell> cells, SeenCells* seen) {
  LF_CHECK(cells.size() <= SeenCells::kAtOnce);
  HWY_DYNAMIC_DISPATCH(FindSeen)(view, cells, seen);
}

}  // namespace lf
#endif  // HWY_ONCE
