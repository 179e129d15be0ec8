// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/prediction_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "lf/pixels/codec/adaptive_bits.h"
#include "lf/pixels/codec/entropy.h"

namespace lf {
namespace {

constexpr uint64_t kPlanes = 0;  // the kind of the warps: homographies of planes

Error DamagedPrediction(std::string_view what) {
  return InputError(fmt::format(
      "is a damaged encoded LF image: {} of its prediction cannot be read; copy or make the packed "
      "store again",
      what));
}

// Returns the depth that is expected of a block: the median of that on the left, that above, and
// the plane through these and the one between them.
int ExpectedDepth(const BlockField& blocks, size_t block) {
  const auto columns = static_cast<size_t>(blocks.columns);
  const bool has_left = block % columns > 0, has_upper = block >= columns;
  if (!has_left && !has_upper) return 0;
  const int left = has_left ? blocks.depths[block - 1] : 0;
  const int upper = has_upper ? blocks.depths[block - columns] : 0;
  if (!has_left) return upper;
  if (!has_upper) return left;
  const int plane = left + upper - blocks.depths[block - columns - 1];
  return std::clamp(plane, std::min(left, upper), std::max(left, upper));
}

// Returns the mask that is expected of a block: that on the left, or above in the first column.
uint8_t ExpectedMask(const BlockField& blocks, size_t block) {
  const auto columns = static_cast<size_t>(blocks.columns);
  if (block % columns > 0) return blocks.masks[block - 1];
  return block >= columns ? blocks.masks[block - columns] : uint8_t{0};
}

// The contexts of the bits that describe blocks.
struct BlockContexts {
  // Indexed by the number of blocks, on the left and above, that have an unexpected depth.
  std::array<BitContext, 3> is_other_depth;
  BitContext is_less;  // the index of depth is less than expected
  NumberContexts<5> difference;
  // Indexed by whether the block on the left has an unexpected mask, and that above.
  std::array<std::array<BitContext, 2>, 2> is_other_mask;
  NumberContexts<kMostReferences> mask;
};

// Calls visit(block, depth context, mask context) for each block, in turn. It returns whether depth
// and mask of the block are other than expected.
template <class Visit>
void ForEachBlock(const BlockField& blocks, BlockContexts* contexts, const Visit& visit) {
  const auto columns = static_cast<size_t>(blocks.columns);
  std::vector<std::array<bool, 2>> others(columns);  // of the blocks above
  for (size_t block = 0; block < blocks.depths.size(); ++block) {
    const size_t column = block % columns;
    const std::array<bool, 2> left = column > 0 ? others[column - 1] : std::array{false, false};
    const std::array<bool, 2> upper = others[column];
    others[column] = visit(block, &contexts->is_other_depth[left[0] + upper[0]],
                           &contexts->is_other_mask[left[1]][upper[1]]);
  }
}

[[nodiscard]] bool TakeWarp(std::string_view* code, PlaneWarp* warp) {
  for (int row = 0; row < 3; ++row) {
    for (int64_t& number : warp->far[row])
      if (!TakeSigned(code, &number)) return false;
    if (!TakeSigned(code, &warp->step[row])) return false;
  }
  return IsWithinLimits(*warp);
}

[[nodiscard]] bool TakeBlocks(std::string_view code, size_t reference_count, BlockField* blocks) {
  BitReader reader(code);
  BlockContexts contexts;
  bool is_whole = true;
  ForEachBlock(*blocks, &contexts, [&](size_t block, BitContext* of_depth, BitContext* of_mask) {
    int depth = ExpectedDepth(*blocks, block);
    const bool is_other_depth = reader.Take(of_depth);
    if (is_other_depth) {
      const bool is_less = reader.Take(&contexts.is_less);
      const int difference = static_cast<int>(contexts.difference.Take(&reader)) + 1;
      depth = (depth + (is_less ? kDepthSteps - difference : difference)) % kDepthSteps;
    }
    unsigned mask = ExpectedMask(*blocks, block);
    const bool is_other_mask = reader.Take(of_mask);
    if (is_other_mask) mask ^= contexts.mask.Take(&reader);
    is_whole = is_whole && mask != 0 && mask >> reference_count == 0;
    blocks->depths[block] = static_cast<uint8_t>(depth);
    blocks->masks[block] = static_cast<uint8_t>(mask);
    return std::array{is_other_depth, is_other_mask};
  });
  return is_whole && reader.IsAtEnd();
}

std::string BytesOfBlocks(const BlockField& blocks) {
  BitWriter writer;
  BlockContexts contexts;
  ForEachBlock(blocks, &contexts, [&](size_t block, BitContext* of_depth, BitContext* of_mask) {
    // The difference modulo the number of depths, from -32 to 31.
    int difference =
        (blocks.depths[block] - ExpectedDepth(blocks, block) + kDepthSteps) % kDepthSteps;
    if (difference >= kDepthSteps / 2) difference -= kDepthSteps;
    writer.Put(difference != 0, of_depth);
    if (difference != 0) {
      writer.Put(difference < 0, &contexts.is_less);
      contexts.difference.Put(static_cast<uint32_t>(std::abs(difference) - 1), &writer);
    }
    const unsigned change = blocks.masks[block] ^ ExpectedMask(blocks, block);
    writer.Put(change != 0, of_mask);
    if (change != 0) contexts.mask.Put(change, &writer);
    return std::array{difference != 0, change != 0};
  });
  return std::move(writer).Finished();
}

}  // namespace

ReferenceSize PredictedSize(PixelLayout layout, int width, int height) {
  if (layout != PixelLayout::kMosaic) return {width, height};
  return {(width + 1) / 2, (height + 1) / 2};
}

std::string BytesOfPrediction(const PredictionCode& prediction) {
  std::string code;
  const BlockField& blocks = prediction.plan.blocks;
  AppendNumber(kPlanes, &code);
  AppendNumber(static_cast<uint64_t>(blocks.block_bits), &code);
  for (size_t r = 0; r < prediction.sizes.size(); ++r) {
    AppendNumber(static_cast<uint64_t>(prediction.sizes[r].width), &code);
    AppendNumber(static_cast<uint64_t>(prediction.sizes[r].height), &code);
    const PlaneWarp& warp = prediction.plan.warps[r];
    for (int row = 0; row < 3; ++row) {
      for (const int64_t number : warp.far[row]) AppendSigned(number, &code);
      AppendSigned(warp.step[row], &code);
    }
  }
  return code + BytesOfBlocks(blocks);
}

Result<PredictionCode> ReadPrediction(const CodeHead& head) {
  const CodeInfo& info = head.info;
  std::string_view code = head.prediction;
  PredictionCode read;
  const ReferenceSize size = PredictedSize(info.layout, info.width, info.height);
  if (std::max(size.width, size.height) > kMostPredictedSide) return DamagedPrediction("the size");
  uint64_t kind = 0, bits = 0;
  if (!TakeNumber(&code, kPlanes, &kind)) return DamagedPrediction("the kind");
  if (!TakeNumber(&code, kMostBlockBits, &bits) || bits < kLeastBlockBits)
    return DamagedPrediction("the size of blocks");
  for (int r = 0; r < info.reference_count; ++r) {
    uint64_t width = 0, height = 0;
    if (!TakeNumber(&code, kMostPredictedSide, &width) || width == 0 ||
        !TakeNumber(&code, kMostPredictedSide, &height) || height == 0)
      return DamagedPrediction("the size of a reference image");
    read.sizes.push_back({static_cast<int>(width), static_cast<int>(height)});
    if (!TakeWarp(&code, &read.plan.warps.emplace_back())) return DamagedPrediction("a warp");
  }
  read.plan.blocks = MakeBlockField(size.width, size.height, static_cast<int>(bits), 0);
  if (!TakeBlocks(code, read.plan.warps.size(), &read.plan.blocks))
    return DamagedPrediction("a block");
  return read;
}

}  // namespace lf
