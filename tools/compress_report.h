// What lfcompressor tells.
#pragma once

#include <string>

#include "tools/common/allow_missing.h"

#include "lf/compress/compress.h"

namespace lf {

// Beside the bar: "12.4 : 1".
std::string ProgressDetail(const CompressProgress& now);

// Ratio, quality, speed; skipped LF images; what to do next.
std::string CompressText(const CompressReport& report, const CompressOptions& options);
std::string CompressJson(const CompressReport& report, const CompressOptions& options);

// The LF images that have no code in the store, of those to be coded.
MissingImages MissingOf(const CompressReport& report, const CompressOptions& options);

}  // namespace lf
