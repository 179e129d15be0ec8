// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a bundle file and, behind the line LIST, its list of images: the result must
// be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_bundler.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  constexpr std::string_view kBorder = "\nLIST\n";
  const size_t at = text.find(kBorder);
  const std::string_view list = at == text.npos ? "" : text.substr(at + kBorder.size());
  lf::CheckExport(lf::ParseBundler(text.substr(0, at), "f/bundle.out", list, "f/list.txt"));
  return 0;
}
