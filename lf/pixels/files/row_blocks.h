// SPDX-License-Identifier: Apache-2.0
// Makes the rows of a picture block by block while they are encoded. Internal to this folder.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lf/pixels/files/picture_encoder.h"

namespace lf {

// Makes kBlockRows rows at a time, and calls encode(rows, row_bytes, count) -> Result<void> for
// each block: `count` rows lie in `rows`, row_bytes apart. Returns the first error of `encode`.
// kInterrupted: is_interrupted() returned true.
template <class Encode>
Result<void> EncodeInBlocks(const PictureRows& picture, const Encode& encode) {
  const size_t value_bytes = picture.type == PixelType::kUint8    ? 1
                             : picture.type == PixelType::kUint16 ? 2
                                                                  : 4;
  const size_t row_bytes = value_bytes * static_cast<size_t>(picture.width) * picture.channels;
  std::vector<std::byte> rows(row_bytes * std::min(kBlockRows, picture.height));
  for (int begin = 0; begin < picture.height; begin += kBlockRows) {
    if (picture.is_interrupted && picture.is_interrupted())
      return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", picture.name)};
    const int count = std::min(kBlockRows, picture.height - begin);
    for (int i = 0; i < count; ++i)
      picture.pack_row(begin + i, rows.data() + row_bytes * static_cast<size_t>(i));
    LF_RETURN_IF_ERROR(encode(rows.data(), row_bytes, count));
  }
  return {};
}

}  // namespace lf
