// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a PFM file: the result must be an error, or the picture that the head states.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/paths/focal_surface_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto read = lf::ParsePfm(text, "f/z.pfm");
  if (!read) {
    LF_CHECK(read.error().message.starts_with("f/z.pfm:"));
    return 0;
  }
  LF_CHECK(read->width() >= 1 && read->height() >= 1);
  LF_CHECK(read->pixels().size() * sizeof(float) <= size_bytes);
  return 0;
}
