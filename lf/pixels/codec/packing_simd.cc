// SPDX-License-Identifier: Apache-2.0
// Unpacks numbers from bytes, compiled for every instruction set; the program chooses one at run
// time (Highway).
#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "lf/pixels/codec/packing_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/pixels/codec/packing_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Number of values that are processed together. They stay in the first-level cache from one step to
// the next.
constexpr size_t kBlock = 2048;
constexpr size_t kRoom = kBlock + 4 * kSlack;  // StoreInterleaved4() may write beyond the block

// Unpacks `size` bytes into one byte for each number. Each byte holds two numbers (kTwo) or four
// (kFour).
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

template <class U>
void Join(const uint8_t* HWY_RESTRICT lower, const uint8_t* HWY_RESTRICT upper, size_t count,
          U* HWY_RESTRICT numbers) {
  const hn::ScalableTag<U> d;
  const hn::Rebind<uint8_t, decltype(d)> d8;
  const size_t lanes = hn::Lanes(d);
  for (size_t i = 0; i < count; i += lanes) {
    const auto high = hn::PromoteTo(d, hn::LoadU(d8, upper + i));
    const auto low = hn::PromoteTo(d, hn::LoadU(d8, lower + i));
    hn::StoreU(hn::Or(low, hn::ShiftLeft<8>(high)), d, numbers + i);
  }
}

#if HWY_TARGET == HWY_SCALAR

template <class U>
void AddEscapes(U escape, std::span<const U> escapes, size_t count, U* numbers, size_t* next) {
  for (size_t i = 0; i < count && *next <= escapes.size(); ++i)
    if (numbers[i] == escape) numbers[i] = static_cast<U>(numbers[i] + escapes.data()[(*next)++]);
}

#else

// Byte shuffles for vectors of 16 bytes, one for each set of lanes that hold escapes. A shuffle
// moves the next remainders into these lanes, in order. The other lanes get a value that is not
// used.
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

// Adds the next remainder of `escapes` to every number that equals `escape`. *next_escape counts
// the remainders used; it ends above escapes.size() if there are more escapes than remainders.
template <class U>
void AddEscapes(U escape, std::span<const U> escapes, size_t count, U* HWY_RESTRICT numbers,
                size_t* next_escape) {
  static const ExpandTable<U> kTable;
  const hn::FixedTag<U, 16 / sizeof(U)> d;
  const hn::FixedTag<uint8_t, 16> d8;
  constexpr size_t kLanes = ExpandTable<U>::kLanes;
  const auto limit = hn::Set(d, escape);
  // No branch depends on whether a lane holds an escape, because the processor could not predict
  // it. The loop checks only before each run whether remainders are left; a run may therefore read
  // into their slack.
  constexpr size_t kRun = 64;
  static_assert(kRun + kLanes <= kSlack);
  size_t next = *next_escape, i = 0;
  for (; i + kRun <= count && next <= escapes.size(); i += kRun)
    for (size_t k = i; k < i + kRun; k += kLanes) {
      const auto v = hn::LoadU(d, numbers + k);
      const auto is_escape = hn::Eq(v, limit);
      uint8_t set[8] = {};
      hn::StoreMaskBits(d, is_escape, set);
      const auto here = hn::BitCast(d8, hn::LoadU(d, escapes.data() + next));
      const auto placed =
          hn::BitCast(d, hn::TableLookupBytes(here, hn::Load(d8, kTable.bytes[set[0]])));
      hn::StoreU(hn::Add(v, hn::IfThenElseZero(is_escape, placed)), d, numbers + k);
      next += static_cast<size_t>(std::popcount(set[0]));
    }
  for (; i < count && next <= escapes.size(); ++i)
    if (numbers[i] == escape) numbers[i] = static_cast<U>(numbers[i] + escapes.data()[next++]);
  *next_escape = next;
}

#endif

// Reverses Folded() (packing.h) in place.
template <class U>
void Unfold(size_t count, U* numbers) {
  const hn::ScalableTag<U> d;
  const size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, U{1});
  for (size_t i = 0; i < count; i += lanes) {
    const auto v = hn::LoadU(d, numbers + i);
    const auto sign = hn::Sub(hn::Zero(d), hn::And(v, one));
    hn::StoreU(hn::Xor(hn::ShiftRight<1>(v), sign), d, numbers + i);
  }
}

template <class U>
bool UnpackOf(const PackedStream<U>& stream, U* numbers) {
  const auto per_byte = static_cast<size_t>(stream.packing);
  const bool is_joined = stream.packing == Packing::kPlanes2;
  HWY_ALIGN uint8_t spread[kRoom];
  size_t next_escape = 0;
  for (size_t begin = 0; begin < stream.count; begin += kBlock) {
    const size_t count = std::min(kBlock, stream.count - begin);
    U* const here = numbers + begin;
    if (is_joined) {
      const uint8_t* const lower = stream.bytes.data() + begin;
      Join(lower, lower + stream.count, count, here);
    } else {
      const uint8_t* from = stream.bytes.data() + begin / per_byte;
      if (per_byte > 1) {
        Spread(stream.packing, from, (count + per_byte - 1) / per_byte, spread);
        from = spread;
      }
      Widen(from, count, here);
      AddEscapes(static_cast<U>(EscapeOf(stream.packing)), stream.escapes, count, here,
                 &next_escape);
    }
    if (stream.has_signs) Unfold(count, here);
  }
  return next_escape == stream.escapes.size();
}

bool Unpack16(const PackedStream<uint16_t>& stream, uint16_t* numbers) {
  return UnpackOf(stream, numbers);
}
bool Unpack32(const PackedStream<uint32_t>& stream, uint32_t* numbers) {
  return UnpackOf(stream, numbers);
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(Unpack16);
HWY_EXPORT(Unpack32);

template <>
bool UnpackSimd(const PackedStream<uint16_t>& stream, uint16_t* numbers) {
  return HWY_DYNAMIC_DISPATCH(Unpack16)(stream, numbers);
}
template <>
bool UnpackSimd(const PackedStream<uint32_t>& stream, uint32_t* numbers) {
  // Streams whose numbers need three or four bytes are rare (only noise has them), and have no SIMD
  // version.
  if (stream.packing == Packing::kPlanes3 || stream.packing == Packing::kPlanes4)
    return UnpackReference(stream, numbers);
  return HWY_DYNAMIC_DISPATCH(Unpack32)(stream, numbers);
}

}  // namespace lf
#endif  // HWY_ONCE
