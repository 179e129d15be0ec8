// SPDX-License-Identifier: Apache-2.0
// ParseReport() must accept or refuse any text. A report that it accepts must have the same numbers
// of frames and skipped LF images when it is written and read again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/render/state/report.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::RenderReport> report = lf::ParseReport(text, "r");
  if (!report) {
    LF_CHECK(report.error().message.starts_with("r: "));
    return 0;
  }
  const std::string written = lf::ToJson(*report);
  const lf::Result<lf::RenderReport> again = lf::ParseReport(written, "r");
  LF_CHECK(again.has_value());
  LF_CHECK(again->frames.size() == report->frames.size() &&
           again->skipped.size() == report->skipped.size());
  return 0;
}
