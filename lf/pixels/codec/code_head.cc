// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/code_head.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/pixels/codec/entropy.h"

namespace lf {
namespace {

constexpr std::string_view kMagic = "LFIM";
// Images that are neither predicted nor coded by contexts are written in the first version, which
// earlier builds read.
constexpr uint64_t kFirstVersion = 1;
constexpr uint64_t kVersion = 2;

Error Damaged(const std::string& what) {
  return InputError(
      fmt::format("is a damaged encoded LF image: {}; copy or make the packed store again", what));
}

// Reads the next number and removes it from `code`. kInput if it cannot be read or is not in
// [low, high].
//   name  what messages call the number
template <class T>
Result<void> Take(std::string_view* code, const char* name, uint64_t low, uint64_t high, T* value) {
  uint64_t number = 0;
  if (!TakeNumber(code, UINT64_MAX, &number))
    return Damaged(fmt::format("its {} cannot be read", name));
  if (number < low || number > high)
    return Damaged(fmt::format("its {} is {}, expected {} to {}", name, number, low, high));
  *value = static_cast<T>(number);
  return {};
}

}  // namespace

int ChannelsOf(PixelLayout layout) { return layout == PixelLayout::kRgb ? 3 : 1; }

PixelRect CodeHead::TileRect(size_t tile) const {
  const int x = static_cast<int>(tile % columns()) * tile_size();
  const int y = static_cast<int>(tile / columns()) * tile_size();
  return {x, y, std::min(x + tile_size(), info.width), std::min(y + tile_size(), info.height)};
}

int CodeHead::components() const {
  switch (info.layout) {
    case PixelLayout::kGrey:
      return 1;
    case PixelLayout::kMosaic:
      return 4;
    case PixelLayout::kRgb:
      break;
  }
  return 3;
}

void AppendHead(const CodeHead& head, std::string* code) {
  *code += kMagic;
  const CodeInfo& info = head.info;
  const bool is_first = !head.is_predicted() && info.entropy == Entropy::kPacked;
  AppendNumber(is_first ? kFirstVersion : kVersion, code);
  AppendNumber(static_cast<uint64_t>(info.profile), code);
  AppendNumber(static_cast<uint64_t>(info.layout), code);
  AppendNumber(static_cast<uint64_t>(info.bits), code);
  AppendNumber(static_cast<uint64_t>(info.width), code);
  AppendNumber(static_cast<uint64_t>(info.height), code);
  AppendNumber(static_cast<uint64_t>(info.levels), code);
  AppendNumber(static_cast<uint64_t>(head.tile_bits), code);
  if (info.profile == CodecProfile::kThesis) {
    AppendNumber(static_cast<uint64_t>(head.quantizer), code);
    AppendSigned(head.low, code);
    AppendSigned(head.high, code);
    return;
  }
  AppendNumber(static_cast<uint64_t>(head.coefficient_bytes), code);
  AppendNumber(static_cast<uint64_t>(head.fraction_bits), code);
  for (const int32_t step : head.steps) AppendNumber(static_cast<uint64_t>(step), code);
  if (is_first) return;
  AppendNumber(static_cast<uint64_t>(info.entropy), code);
  AppendNumber(static_cast<uint64_t>(info.reference_count), code);
  if (!head.is_predicted()) return;
  AppendNumber(head.prediction.size(), code);
  *code += head.prediction;
}

Result<CodeHead> TakeHead(std::string_view* code) {
  std::string_view magic;
  if (!TakeBytes(code, kMagic.size(), &magic) || magic != kMagic)
    return InputError(
        "is no encoded LF image: it does not begin with LFIM; copy or make the packed store again");
  uint64_t version = 0;
  LF_RETURN_IF_ERROR(Take(code, "version", 0, UINT64_MAX, &version));
  if (version == 0) return Damaged(fmt::format("its version is 0, expected 1 to {}", kVersion));
  if (version > kVersion)
    return InputError(
        fmt::format("is an encoded LF image of version {}, which a newer lfrendertools has "
                    "written; this one knows the versions up to {}: use the newer one",
                    version, kVersion));
  CodeHead head;
  CodeInfo& info = head.info;
  const uint64_t least_profile = version == kFirstVersion ? 0 : 1;  // thesis has the first version
  LF_RETURN_IF_ERROR(Take(code, "profile", least_profile, 2, &info.profile));
  LF_RETURN_IF_ERROR(Take(code, "layout", 0, 2, &info.layout));
  LF_RETURN_IF_ERROR(Take(code, "depth in bits", 8, 16, &info.bits));
  if (info.bits % 8 != 0)
    return Damaged(fmt::format("its depth in bits is {}, expected 8 or 16", info.bits));
  LF_RETURN_IF_ERROR(Take(code, "width", 1, kMostPixels, &info.width));
  LF_RETURN_IF_ERROR(Take(code, "height", 1, kMostPixels, &info.height));
  if (static_cast<long long>(info.width) * info.height > kMostPixels)
    return Damaged(fmt::format("its size of {} x {} is not between 1 and 2^30 pixels", info.width,
                               info.height));
  LF_RETURN_IF_ERROR(Take(code, "number of levels", 1, kMostLevels, &info.levels));
  LF_RETURN_IF_ERROR(Take(code, "binary logarithm of the side of a tile", kLeastTileBits,
                          kMostTileBits, &head.tile_bits));
  if (info.profile == CodecProfile::kThesis) {
    LF_RETURN_IF_ERROR(Take(code, "quantizer", 2, 65536, &head.quantizer));
    // Largest magnitude of a coefficient: 16 bits of a pixel and kHaarBits fraction bits. The
    // synthesis adds at most 16 coefficients, so that their sum fits in 32 bits.
    constexpr int64_t kLimit = int64_t{1} << 26;
    if (!TakeSigned(code, &head.low) || !TakeSigned(code, &head.high))
      return Damaged("its range of coefficients cannot be read");
    if (head.low < -kLimit || head.high > kLimit || head.low > head.high)
      return Damaged(
          fmt::format("its range of coefficients is {} to {}, expected it within {} to {}",
                      head.low, head.high, -kLimit, kLimit));
    return head;
  }
  LF_RETURN_IF_ERROR(Take(code, "size of a coefficient in bytes", 2, 4, &head.coefficient_bytes));
  if (head.coefficient_bytes % 2 != 0 || (info.bits == 16 && head.coefficient_bytes == 2))
    return Damaged(fmt::format("its size of a coefficient in bytes is {}, expected {}",
                               head.coefficient_bytes, info.bits == 16 ? "4" : "2 or 4"));
  LF_RETURN_IF_ERROR(Take(code, "number of fraction bits", 0, 4, &head.fraction_bits));
  head.steps.resize(head.StepCount());
  const uint64_t largest_step = head.coefficient_bytes == 2 ? INT16_MAX : 1 << 24;
  for (int32_t& step : head.steps)
    LF_RETURN_IF_ERROR(Take(code, "step of a quantiser", 1, largest_step, &step));
  if (version == kFirstVersion) return head;
  LF_RETURN_IF_ERROR(Take(code, "entropy coder", 0, 1, &info.entropy));
  LF_RETURN_IF_ERROR(
      Take(code, "number of reference images", 0, kMostReferenceCount, &info.reference_count));
  if (!head.is_predicted()) return head;
  uint64_t bytes = 0;
  LF_RETURN_IF_ERROR(Take(code, "number of bytes of its prediction", 0, UINT32_MAX, &bytes));
  if (!TakeBytes(code, bytes, &head.prediction))
    return Damaged("it is shorter than its prediction");
  return head;
}

}  // namespace lf
