// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a cameras.xml of Metashape: the result must be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/log.h"
#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_metashape.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::SetLogLevel(lf::LogLevel::kError);
  lf::CheckExport(lf::ParseMetashape(text, "f/cameras.xml"));
  return 0;
}
