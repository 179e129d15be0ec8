// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as the files of a kapture data set, which NUL characters separate: the result
// must be valid cameras or an error.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/log.h"
#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_kapture.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::SetLogLevel(lf::LogLevel::kError);
  lf::KaptureTexts texts;
  std::string_view rest = text;
  for (std::string_view* const file :
       {&texts.sensors, &texts.records, &texts.trajectories, &texts.rigs}) {
    *file = rest.substr(0, rest.find(static_cast<char>(0)));
    rest.remove_prefix(std::min(rest.size(), file->size() + 1));
  }
  lf::CheckExport(lf::ParseKapture(texts, "f/sensors"));
  return 0;
}
