// SPDX-License-Identifier: Apache-2.0
// Writes the weights of blocks of elements, compiled for every instruction set from one source
// (Highway).
#include <algorithm>
#include <cstring>
#include <vector>

#include "lf/collection/tile_weights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lf/collection/tile_weights_simd.cc"  // NOLINT: as Highway wants it
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lf {
namespace HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
// One lane at a time would be slower.
HWY_ATTR void FillRows(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch,
                       uint8_t* to) {
  FillBlocksReference(blocks, j_begin, j_end, pitch, to);
}
#else
namespace hn = hwy::HWY_NAMESPACE;

// Writes the weights of blocks without feather.
HWY_ATTR void FillPlain(std::span<const uint8_t> weights, int row_count, ptrdiff_t pitch,
                        uint8_t* to) {
  const hn::ScalableTag<uint8_t> d;
  const hn::Full64<uint8_t> d64;
  const size_t lanes = hn::Lanes(d), blocks_at_once = lanes / kWeightBlock;
  const auto block_of_lane = hn::ShiftRight<3>(hn::Iota(d, 0));
  size_t k = 0;
  for (; k + blocks_at_once <= weights.size(); k += blocks_at_once, to += lanes) {
    uint8_t some[16] = {};  // TableLookupBytes() looks up in 16 bytes
    std::memcpy(some, weights.data() + k, blocks_at_once);
    const auto of_elements = hn::TableLookupBytes(hn::LoadDup128(d, some), block_of_lane);
    for (int row = 0; row < row_count; ++row) hn::StoreU(of_elements, d, to + row * pitch);
  }
  for (; k < weights.size(); ++k, to += kWeightBlock)
    for (int row = 0; row < row_count; ++row)
      hn::StoreU(hn::Set(d64, weights[k]), d64, to + row * pitch);
}

// Finds the blocks that the feather changes. Appends the indices of blocks with a partial feather
// to `feathered`. Sets the weights, unless they are 0, of blocks without any feather to 1: this is
// the least weight that FeatheredWeight() gives.
HWY_ATTR void SortOut(const RowOfBlocks& blocks, std::vector<int>* feathered) {
  const hn::ScalableTag<uint16_t> d;
  const size_t lanes = hn::Lanes(d), count = blocks.weights.size();
  for (size_t begin = 0; begin < count; begin += lanes) {
    const size_t end = std::min(begin + lanes, count);
    if (end == begin + lanes) {
      // Most blocks are whole. Only the whole feather has this bit.
      const auto all = hn::And(
          hn::And(hn::LoadU(d, blocks.above + begin), hn::LoadU(d, blocks.above + begin + 1)),
          hn::And(hn::LoadU(d, blocks.below + begin), hn::LoadU(d, blocks.below + begin + 1)));
      if (hn::AllTrue(d, hn::Eq(all, hn::Set(d, uint16_t{kWholeFeather})))) continue;
    }
    for (size_t k = begin; k < end; ++k) {
      const uint16_t *const above = blocks.above + k, *const below = blocks.below + k;
      if ((above[0] & above[1] & below[0] & below[1]) == kWholeFeather) continue;
      uint8_t& weight = blocks.weights[k];
      if ((above[0] | above[1] | below[0] | below[1]) == 0)
        weight = std::min<uint8_t>(weight, 1);
      else if (weight > 0)
        feathered->push_back(static_cast<int>(k));
    }
  }
}

// Writes the weights of a block with a partial feather and a weight above 0. All numbers fit
// in 16 bits: the feather, in units of 2^-16, is less than 1. It changes by the same amount from
// row to row.
HWY_ATTR void FillFeathered(uint8_t weight, const uint16_t* above, const uint16_t* below,
                            int j_begin, int j_end, ptrdiff_t pitch, uint8_t* to) {
  static_assert(kWeightBlock == 8 && kWholeFeather == 256);
  constexpr int kOne = 2 * kWeightBlock;
  const hn::CappedTag<uint16_t, kWeightBlock> d;
  const hn::Repartition<int16_t, decltype(d)> d_signed;
  const hn::Rebind<uint8_t, decltype(d)> d8;
  const auto right = hn::Add(hn::Add(hn::Iota(d, 0), hn::Iota(d, 0)), hn::Set(d, uint16_t{1}));
  const auto left = hn::Sub(hn::Set(d, uint16_t{kOne}), right);
  const auto across = [&](const uint16_t* of_corners) HWY_ATTR {
    return hn::Add(hn::Mul(hn::Set(d, of_corners[0]), left),
                   hn::Mul(hn::Set(d, of_corners[1]), right));
  };
  const auto upper = across(above), lower = across(below);
  const int down = 2 * j_begin + 1;
  auto feather = hn::Add(hn::Mul(upper, hn::Set(d, static_cast<uint16_t>(kOne - down))),
                         hn::Mul(lower, hn::Set(d, static_cast<uint16_t>(down))));
  const auto half_step = hn::Sub(lower, upper), step = hn::Add(half_step, half_step);
  const auto full = hn::Set(d, uint16_t{weight}), least = hn::Set(d, uint16_t{1});
  for (int j = j_begin; j < j_end; ++j, to += pitch) {
    // The upper half of the product, rounded by the highest bit of the lower half.
    const auto product =
        hn::Add(hn::MulHigh(full, feather), hn::ShiftRight<15>(hn::Mul(full, feather)));
    const auto of_row = hn::BitCast(d_signed, hn::Max(product, least));
    hn::StoreU(hn::DemoteTo(d8, of_row), d8, to);
    feather = hn::Add(feather, step);
  }
}

HWY_ATTR void FillRows(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch,
                       uint8_t* to) {
  thread_local std::vector<int> feathered;
  feathered.clear();
  if (blocks.above != nullptr) SortOut(blocks, &feathered);
  FillPlain(blocks.weights, j_end - j_begin, pitch, to);
  for (const int k : feathered)
    FillFeathered(blocks.weights[static_cast<size_t>(k)], blocks.above + k, blocks.below + k,
                  j_begin, j_end, pitch, to + static_cast<ptrdiff_t>(k) * kWeightBlock);
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace lf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lf {
HWY_EXPORT(FillRows);

void FillBlocks(const RowOfBlocks& blocks, int j_begin, int j_end, ptrdiff_t pitch, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(FillRows)(blocks, j_begin, j_end, pitch, to);
}

}  // namespace lf
#endif
