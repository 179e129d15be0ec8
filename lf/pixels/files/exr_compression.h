// SPDX-License-Identifier: Apache-2.0
// How EXR files are compressed.
#pragma once

#include <optional>
#include <string_view>

namespace lf {

// Both ways lose nothing, and differ in the number of rows that are compressed together.
enum class ExrCompression {
  kZip,   // "zip": 16 rows, which gives smaller files
  kZips,  // "zips": one row, so that programs that read a picture row by row decode no row twice
};

// Parses "zip" or "zips"; none for any other text.
std::optional<ExrCompression> ParseExrCompression(std::string_view name);
const char* NameOf(ExrCompression compression);

}  // namespace lf
