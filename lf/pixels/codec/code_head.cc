#include "lf/pixels/codec/code_head.h"

#include <fmt/format.h>

#include <algorithm>

#include "lf/pixels/codec/entropy.h"

namespace lf {
namespace {

constexpr std::string_view kMagic = "LFIM";
constexpr uint64_t kVersion = 1;

// AppendSigned() and TakeSigned() write and read a signed number, whose sign is stored in the
// lowest bit.
void AppendSigned(int64_t number, std::string* code) {
  AppendNumber((static_cast<uint64_t>(number) << 1) ^ static_cast<uint64_t>(number >> 63), code);
}
bool TakeSigned(std::string_view* code, int64_t* number) {
  uint64_t folded = 0;
  if (!TakeNumber(code, UINT64_MAX, &folded)) return false;
  *number = static_cast<int64_t>((folded >> 1) ^ (0 - (folded & 1)));
  return true;
}

Error Damaged(const char* what) {
  return InputError(fmt::format("is a damaged encoded LF image: {}", what));
}

// Reads the next number and removes it from `code`. Returns false if it is not in [low, high].
template <class T>
bool Take(std::string_view* code, uint64_t low, uint64_t high, T* value) {
  uint64_t number = 0;
  if (!TakeNumber(code, high, &number) || number < low) return false;
  *value = static_cast<T>(number);
  return true;
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
  AppendNumber(kVersion, code);
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
}

Result<CodeHead> TakeHead(std::string_view* code) {
  std::string_view magic;
  if (!TakeBytes(code, kMagic.size(), &magic) || magic != kMagic)
    return InputError("is no encoded LF image: it does not begin with LFIM");
  uint64_t version = 0;
  if (!TakeNumber(code, UINT64_MAX, &version) || version == 0)
    return Damaged("its version is invalid");
  if (version > kVersion)
    return InputError(
        fmt::format("is an encoded LF image of version {}, which a newer lfrendertools has "
                    "written; this one knows version {}",
                    version, kVersion));
  CodeHead head;
  CodeInfo& info = head.info;
  if (!Take(code, 0, 2, &info.profile)) return Damaged("its profile is invalid");
  if (!Take(code, 0, 2, &info.layout)) return Damaged("its layout is invalid");
  if (!Take(code, 8, 16, &info.bits) || info.bits % 8 != 0) return Damaged("its depth is invalid");
  if (!Take(code, 1, kMostPixels, &info.width) || !Take(code, 1, kMostPixels, &info.height) ||
      static_cast<long long>(info.width) * info.height > kMostPixels)
    return Damaged("its size is not between 1 and 2^30 pixels");
  if (!Take(code, 1, kMostLevels, &info.levels)) return Damaged("its number of levels is invalid");
  if (!Take(code, kLeastTileBits, kMostTileBits, &head.tile_bits))
    return Damaged("the size of its tiles is invalid");
  if (info.profile == CodecProfile::kThesis) {
    if (!Take(code, 2, 65536, &head.quantizer)) return Damaged("its quantizer is invalid");
    constexpr int64_t kLimit = int64_t{1} << 26;  // largest coefficient: 16 bits of a pixel, and
                                                  // kHaarBits; sums of several fit 32 bits
    if (!TakeSigned(code, &head.low) || !TakeSigned(code, &head.high) || head.low < -kLimit ||
        head.high > kLimit || head.low > head.high)
      return Damaged("the range of its coefficients is invalid");
    return head;
  }
  if (!Take(code, 2, 4, &head.coefficient_bytes) || head.coefficient_bytes % 2 != 0 ||
      (info.bits == 16 && head.coefficient_bytes == 2))
    return Damaged("the size of its coefficients is invalid");
  if (!Take(code, 0, 4, &head.fraction_bits))
    return Damaged("its number of fraction bits is invalid");
  head.steps.resize(head.StepCount());
  for (int32_t& step : head.steps)
    if (!Take(code, 1, head.coefficient_bytes == 2 ? INT16_MAX : 1 << 24, &step))
      return Damaged("a step of its quantisers is invalid");
  return head;
}

}  // namespace lf
