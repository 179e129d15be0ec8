// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/prediction_code.h"

#include <fmt/format.h>

#include <algorithm>

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

void AppendBytes(std::span<const uint8_t> bytes, std::string* code) {
  std::string compressed;
  AppendCompressed(bytes, &compressed);
  AppendNumber(compressed.size(), code);
  *code += compressed;
}

[[nodiscard]] bool TakeCompressed(std::string_view* code, std::span<uint8_t> bytes) {
  uint64_t size = 0;
  std::string_view compressed;
  return TakeNumber(code, code->size(), &size) && TakeBytes(code, size, &compressed) &&
         Decompress(compressed, bytes);
}

[[nodiscard]] bool TakeWarp(std::string_view* code, PlaneWarp* warp) {
  for (int row = 0; row < 3; ++row) {
    for (int64_t& number : warp->far[row])
      if (!TakeSigned(code, &number)) return false;
    if (!TakeSigned(code, &warp->step[row])) return false;
  }
  return IsWithinLimits(*warp);
}

[[nodiscard]] bool TakeBlocks(std::string_view* code, size_t reference_count, BlockField* blocks) {
  const size_t count = blocks->depths.size();
  const unsigned masks = 1U << reference_count;
  std::vector<uint8_t> depths(count), masks_read(count);
  if (!TakeCompressed(code, depths) || !TakeCompressed(code, masks_read)) return false;
  for (size_t i = 0; i < count; ++i) {
    if (depths[i] >= kDepthSteps || masks_read[i] >= masks) return false;
    blocks->depths[i] = static_cast<uint8_t>((ExpectedDepth(*blocks, i) + depths[i]) % kDepthSteps);
    blocks->masks[i] = static_cast<uint8_t>(ExpectedMask(*blocks, i) ^ masks_read[i]);
    if (blocks->masks[i] == 0) return false;
  }
  return true;
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
  std::vector<uint8_t> depths(blocks.depths.size()), masks(blocks.masks.size());
  for (size_t i = 0; i < depths.size(); ++i) {
    depths[i] = static_cast<uint8_t>((blocks.depths[i] + kDepthSteps - ExpectedDepth(blocks, i)) %
                                     kDepthSteps);
    masks[i] = static_cast<uint8_t>(blocks.masks[i] ^ ExpectedMask(blocks, i));
  }
  AppendBytes(depths, &code);
  AppendBytes(masks, &code);
  return code;
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
  if (!TakeBlocks(&code, read.plan.warps.size(), &read.plan.blocks) || !code.empty())
    return DamagedPrediction("a block");
  return read;
}

}  // namespace lf
