// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a trajectory of TUM's form and, behind the line LIST, its list of images: the
// result must be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_tum.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  constexpr std::string_view kBorder = "\nLIST\n";
  const size_t at = text.find(kBorder);
  const std::string_view list = at == text.npos ? "" : text.substr(at + kBorder.size());
  lf::CheckExport(lf::ParseTum(text.substr(0, at), "f/groundtruth.txt", list, "f/rgb.txt", 525));
  return 0;
}
