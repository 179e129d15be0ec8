// What lfcompressor tells.
#pragma once

#include <string>

#include "lf/compress/compress.h"

namespace lf {

// Beside the bar: "12.4 : 1".
std::string ProgressDetail(const CompressProgress& now);

// Ratio, quality, speed; skipped LF images; what to do next.
std::string CompressText(const CompressReport& report, const CompressOptions& options);
std::string CompressJson(const CompressReport& report, const CompressOptions& options);

}  // namespace lf
