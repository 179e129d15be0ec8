// SPDX-License-Identifier: Apache-2.0
// Reads the rows of pictures whose pixels lie in the file as they are. Internal to this folder.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/pixels/files/file_bytes.h"

namespace lf {

struct RowsInFile {
  uint64_t begin = 0;      // offset of the first row of the file
  uint64_t row_bytes = 0;  // from one row to the next
  int row_count = 0;
  bool is_upside_down = false;  // true: the first row of the file is the lowest of the picture
};

// kInput if the file ends before the last row.
//   format  name of the format, for the message
inline Result<void> CheckRowsAreThere(const FileBytes& file, const RowsInFile& rows,
                                      const char* format) {
  const uint64_t row_count = static_cast<uint64_t>(rows.row_count);
  if (rows.begin <= file.size_bytes && (file.size_bytes - rows.begin) / row_count >= rows.row_bytes)
    return {};
  return InputError(
      fmt::format("{}: {} file is truncated: its pixels take {} bytes from byte {} on, but it has "
                  "{} bytes",
                  file.name, format, row_count * rows.row_bytes, rows.begin, file.size_bytes));
}

// Calls convert(const uint8_t* row, int y) for the rows [y_begin, y_end) of the picture, where
// `row` has rows.row_bytes bytes. kInput: the file has become shorter.
template <class Convert>
Result<void> ForEachRowInFile(const FileBytes& file, const RowsInFile& rows, int y_begin, int y_end,
                              const Convert& convert) {
  std::vector<uint8_t> buffer(rows.row_bytes);
  for (int y = y_begin; y < y_end; ++y) {
    const int row = rows.is_upside_down ? rows.row_count - 1 - y : y;
    if (file.read(rows.begin + static_cast<uint64_t>(row) * rows.row_bytes, buffer) !=
        buffer.size())
      return InputError(fmt::format("{}: truncated while it was read", file.name));
    convert(buffer.data(), y);
  }
  return {};
}

}  // namespace lf
