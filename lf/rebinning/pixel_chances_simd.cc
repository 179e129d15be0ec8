// SPDX-License-Identifier: Apache-2.0
// PixelChances::Choose(), compiled for every instruction set; the program chooses one at run time
// (Highway).
#include <algorithm>
#include <bit>
#include <cstring>

#include "lf/rebinning/pixel_chances.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/rebinning/pixel_chances_simd.cc"  // NOLINT: Highway reads this macro
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<uint32_t, 16>;  // each lane stands for two pixels
#if HWY_TARGET == HWY_SCALAR
using D16 = hn::Rebind<uint16_t, D>;
#else
using D16 = hn::Repartition<uint16_t, D>;
#endif

// Appends base + i to `chosen` for each chosen i of [0, count). p must be readable for one vector
// beyond its end.
//   pair  number, in the LF image, of the pair of pixels 0 and 1
void ChooseSome(uint64_t stream, uint64_t pair, const uint16_t* HWY_RESTRICT p, size_t count,
                uint32_t base, uint32_t* HWY_RESTRICT chosen, size_t* chosen_count) {
  const D d;
  [[maybe_unused]] const D16 d16;  // unused if the target has no vectors
  const auto low = hn::Set(d, static_cast<uint32_t>(stream));
  const auto high = hn::Set(d, static_cast<uint32_t>(stream >> 32));
  const auto first = hn::Set(d, PixelChances::kFirst), second = hn::Set(d, PixelChances::kSecond);
  size_t found = *chosen_count;
  const size_t pairs = hn::Lanes(d);
  for (size_t begin = 0; begin < count; begin += 2 * pairs) {
    auto hash = hn::Xor(hn::Iota(d, static_cast<uint32_t>(pair + begin / 2)), low);
    hash = hn::Xor(hash, hn::ShiftRight<16>(hash));
    hash = hn::Add(hn::Mul(hash, first), high);
    hash = hn::Xor(hash, hn::ShiftRight<15>(hash));
    hash = hn::Mul(hash, second);
    hash = hn::Xor(hash, hn::ShiftRight<16>(hash));
#if HWY_TARGET == HWY_SCALAR
    uint64_t bits = 0;
    for (uint32_t i = 0; i < 2; ++i)
      bits |= uint64_t{((hn::GetLane(hash) >> (16 * i) & 0xffff) * 65535 >> 16) < p[begin + i]}
              << i;
#else
    const auto number = hn::MulHigh(hn::BitCast(d16, hash), hn::Set(d16, uint16_t{65535}));
    const auto mask = hn::Lt(number, hn::LoadU(d16, p + begin));
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d16, mask, bytes);
    uint64_t bits;
    std::memcpy(&bits, bytes, sizeof(bits));
#endif
    if (begin + 2 * pairs > count) bits &= (uint64_t{1} << (count - begin)) - 1;
    for (; bits != 0; bits &= bits - 1)
      chosen[found++] =
          base + static_cast<uint32_t>(begin) + static_cast<uint32_t>(std::countr_zero(bits));
  }
  *chosen_count = found;
}

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {

HWY_EXPORT(ChooseSome);

void PixelChances::Choose(uint64_t first, std::span<const uint16_t> p,
                          std::vector<uint32_t>* chosen) const {
  constexpr size_t kAtOnce = 1024, kMargin = 32;
  uint16_t padded[kAtOnce + kMargin] = {};
  chosen->resize(p.size());
  size_t count = 0, begin = 0;
  if (first % 2 == 1 && !p.empty()) {
    if (Chooses(first, p[0])) (*chosen)[count++] = 0;
    begin = 1;
  }
  for (; begin < p.size(); begin += kAtOnce) {
    const auto some = p.subspan(begin, std::min(kAtOnce, p.size() - begin));
    std::memcpy(padded, some.data(), some.size_bytes());
    HWY_DYNAMIC_DISPATCH(ChooseSome)
    (stream_, (first + begin) / 2, padded, some.size(), static_cast<uint32_t>(begin),
     chosen->data(), &count);
  }
  chosen->resize(count);
}

}  // namespace lf
#endif  // HWY_ONCE
