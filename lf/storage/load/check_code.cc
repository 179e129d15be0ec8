// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/check_code.h"

#include <fmt/format.h>

namespace lf {

Result<void> CheckCode(std::string_view bytes, int bits, PixelLayout layout, bool grey_too,
                       const PixelRect& rect) {
  LF_ASSIGN_OR_RETURN(const CodeInfo info, ReadCodeInfo(bytes));
  if (info.width != rect.width() || info.height != rect.height())
    return InputError(
        fmt::format("is damaged in the packed store: its encoded image has {} x {} pixels, but the "
                    "table of the store says {} x {}; copy or make the store again",
                    info.width, info.height, rect.width(), rect.height()));
  const bool has_layout = info.layout == layout || (grey_too && info.layout == PixelLayout::kGrey);
  if (info.bits != bits || !has_layout)
    return InputError(
        "is damaged in the packed store: its encoded image has another number of bits or channels "
        "than the table of the store says; copy or make the store again");
  return {};
}

Result<void> CheckColours(std::string_view bytes, const PackedCode& code, BayerPattern bayer) {
  const bool is_mosaic = bayer != BayerPattern::kNone;
  return CheckCode(bytes, BitsOf(code.values), is_mosaic ? PixelLayout::kMosaic : PixelLayout::kRgb,
                   !is_mosaic, code.rect);
}

}  // namespace lf
