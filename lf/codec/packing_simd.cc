// Numbers from packed bytes, compiled for every instruction set and chosen as the program runs
// (Highway).
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "lf/codec/packing_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/codec/packing_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBlock = 2048;                // numbers at a time, in the first-level cache
constexpr size_t kRoom = kBlock + 4 * kSlack;  // vectors of four times the width may end beyond

// A byte for each number, from `size` bytes.
void Spread(Packing packing, const uint8_t* HWY_RESTRICT bytes, size_t size,
            uint8_t* HWY_RESTRICT out) {
  const hn::ScalableTag<uint8_t> d;
  const size_t lanes = hn::Lanes(d);
  if (packing == Packing::kTwo) {
    const auto mask = hn::Set(d, uint8_t{15});
    for (size_t i = 0; i < size; i += lanes) {
      const auto pair = hn::LoadU(d, bytes + i);
      hn::StoreInterleaved2(hn::And(pair, mask), hn::ShiftRight<4>(pair), d, out + 2 * i);
    }
    return;
  }
  const auto mask = hn::Set(d, uint8_t{3});
  for (size_t i = 0; i < size; i += lanes) {
    const auto four = hn::LoadU(d, bytes + i);
    hn::StoreInterleaved4(hn::And(four, mask), hn::And(hn::ShiftRight<2>(four), mask),
                          hn::And(hn::ShiftRight<4>(four), mask), hn::ShiftRight<6>(four), d,
                          out + 4 * i);
  }
}

template <class U>
void Widen(const uint8_t* HWY_RESTRICT bytes, size_t count, U* HWY_RESTRICT numbers) {
  const hn::ScalableTag<U> d;
  const hn::Rebind<uint8_t, decltype(d)> d8;
  const size_t lanes = hn::Lanes(d);
  for (size_t i = 0; i < count; i += lanes)
    hn::StoreU(hn::PromoteTo(d, hn::LoadU(d8, bytes + i)), d, numbers + i);
}

// Two bytes each, the lower ones of all before the upper ones.
template <class U>
void JoinTwo(const uint8_t* HWY_RESTRICT bytes, size_t count, U* HWY_RESTRICT numbers) {
  const hn::ScalableTag<U> d;
  const hn::Rebind<uint8_t, decltype(d)> d8;
  const size_t lanes = hn::Lanes(d);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto lower = hn::PromoteTo(d, hn::LoadU(d8, bytes + i));
    const auto upper = hn::PromoteTo(d, hn::LoadU(d8, bytes + count + i));
    hn::StoreU(hn::Or(lower, hn::ShiftLeft<8>(upper)), d, numbers + i);
  }
  for (; i < count; ++i) numbers[i] = static_cast<U>(bytes[i] | bytes[count + i] << 8);
}

template <class U>
void UnpackOf(Packing packing, const uint8_t* bytes, size_t count, U* numbers) {
  const auto per_byte = static_cast<size_t>(packing);
  HWY_ALIGN uint8_t in[kRoom];
  HWY_ALIGN uint8_t spread[kRoom];
  for (size_t begin = 0; begin < count; begin += kBlock) {
    const size_t here = std::min(kBlock, count - begin);
    const size_t size = (here + per_byte - 1) / per_byte;
    const uint8_t* from = bytes + begin / per_byte;
    // No byte behind the last may be read.
    if (begin + kBlock + per_byte * kSlack > count) {
      std::memcpy(in, from, size);
      std::memset(in + size, 0, kSlack);
      from = in;
    }
    if (per_byte > 1) {
      Spread(packing, from, size, spread);
      from = spread;
    }
    Widen(from, here, numbers + begin);
  }
}

#if HWY_TARGET == HWY_SCALAR

template <class U>
size_t AddEscapesOf(U escape, const U* escapes, size_t escape_count, size_t count, U* numbers) {
  return AddEscapesReference(escape, escapes, escape_count, count, numbers);
}

#else

// For each set of lanes of 16 bytes that are escapes, the bytes that bring the next escapes into
// them, in turn; lanes that are none get what is added to nothing.
template <class U>
struct ExpandTable {
  static constexpr size_t kLanes = 16 / sizeof(U);
  HWY_ALIGN uint8_t bytes[size_t{1} << kLanes][16];

  ExpandTable() {
    for (size_t set = 0; set < size_t{1} << kLanes; ++set) {
      size_t next = 0;
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const size_t from = (set >> lane & 1) != 0 ? next++ : 0;
        for (size_t k = 0; k < sizeof(U); ++k)
          bytes[set][lane * sizeof(U) + k] = static_cast<uint8_t>(from * sizeof(U) + k);
      }
    }
  }
};

template <class U>
size_t AddEscapesOf(U escape, const U* HWY_RESTRICT escapes, size_t escape_count, size_t count,
                    U* HWY_RESTRICT numbers) {
  static const ExpandTable<U> kTable;
  const hn::FixedTag<U, 16 / sizeof(U)> d;
  const hn::FixedTag<uint8_t, 16> d8;
  constexpr size_t kLanes = ExpandTable<U>::kLanes;
  const auto limit = hn::Set(d, escape);
  // No branch asks whether there is an escape: it could not be foreseen. What is left of them is
  // looked at before each run, which may read as far as their slack.
  constexpr size_t kRun = 64;
  static_assert(kRun + kLanes <= kSlack);
  size_t next = 0, i = 0;
  for (; i + kRun <= count && next <= escape_count; i += kRun)
    for (size_t k = i; k < i + kRun; k += kLanes) {
      const auto v = hn::LoadU(d, numbers + k);
      const auto is_escape = hn::Eq(v, limit);
      uint8_t set[8] = {};
      hn::StoreMaskBits(d, is_escape, set);
      const auto here = hn::BitCast(d8, hn::LoadU(d, escapes + next));
      const auto placed =
          hn::BitCast(d, hn::TableLookupBytes(here, hn::Load(d8, kTable.bytes[set[0]])));
      hn::StoreU(hn::Add(v, hn::IfThenElseZero(is_escape, placed)), d, numbers + k);
      next += static_cast<size_t>(std::popcount(set[0]));
    }
  for (; i < count && next <= escape_count; ++i) {
    if (numbers[i] != escape) continue;
    numbers[i] = static_cast<U>(numbers[i] + escapes[next]);
    ++next;
  }
  return next;
}

#endif

template <class U>
void UnfoldOf(size_t count, U* numbers) {
  const hn::ScalableTag<U> d;
  const size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, U{1});
  for (size_t i = 0; i < count; i += lanes) {
    const auto v = hn::LoadU(d, numbers + i);
    const auto sign = hn::Sub(hn::Zero(d), hn::And(v, one));
    hn::StoreU(hn::Xor(hn::ShiftRight<1>(v), sign), d, numbers + i);
  }
}

void Unpack16(Packing packing, const uint8_t* bytes, size_t count, uint16_t* numbers) {
  packing == Packing::kPlanes2 ? JoinTwo(bytes, count, numbers)
                               : UnpackOf(packing, bytes, count, numbers);
}
void Unpack32(Packing packing, const uint8_t* bytes, size_t count, uint32_t* numbers) {
  packing == Packing::kPlanes2 ? JoinTwo(bytes, count, numbers)
                               : UnpackOf(packing, bytes, count, numbers);
}
size_t AddEscapes16(uint16_t escape, const uint16_t* escapes, size_t escape_count, size_t count,
                    uint16_t* numbers) {
  return AddEscapesOf(escape, escapes, escape_count, count, numbers);
}
size_t AddEscapes32(uint32_t escape, const uint32_t* escapes, size_t escape_count, size_t count,
                    uint32_t* numbers) {
  return AddEscapesOf(escape, escapes, escape_count, count, numbers);
}
void Unfold16(size_t count, uint16_t* numbers) { UnfoldOf(count, numbers); }
void Unfold32(size_t count, uint32_t* numbers) { UnfoldOf(count, numbers); }

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(Unpack16);
HWY_EXPORT(Unpack32);
HWY_EXPORT(AddEscapes16);
HWY_EXPORT(AddEscapes32);
HWY_EXPORT(Unfold16);
HWY_EXPORT(Unfold32);

template <>
void UnpackSimd(Packing packing, const uint8_t* bytes, size_t count, uint16_t* numbers) {
  HWY_DYNAMIC_DISPATCH(Unpack16)(packing, bytes, count, numbers);
}
template <>
void UnpackSimd(Packing packing, const uint8_t* bytes, size_t count, uint32_t* numbers) {
  if (packing == Packing::kPlanes3 || packing == Packing::kPlanes4)
    UnpackReference(packing, bytes, count, numbers);
  else
    HWY_DYNAMIC_DISPATCH(Unpack32)(packing, bytes, count, numbers);
}
template <>
size_t AddEscapesSimd(uint16_t escape, const uint16_t* escapes, size_t escape_count, size_t count,
                      uint16_t* numbers) {
  return HWY_DYNAMIC_DISPATCH(AddEscapes16)(escape, escapes, escape_count, count, numbers);
}
template <>
size_t AddEscapesSimd(uint32_t escape, const uint32_t* escapes, size_t escape_count, size_t count,
                      uint32_t* numbers) {
  return HWY_DYNAMIC_DISPATCH(AddEscapes32)(escape, escapes, escape_count, count, numbers);
}
template <>
void UnfoldSimd(size_t count, uint16_t* numbers) {
  HWY_DYNAMIC_DISPATCH(Unfold16)(count, numbers);
}
template <>
void UnfoldSimd(size_t count, uint32_t* numbers) {
  HWY_DYNAMIC_DISPATCH(Unfold32)(count, numbers);
}

}  // namespace lf
#endif  // HWY_ONCE
