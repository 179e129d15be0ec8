// SPDX-License-Identifier: Apache-2.0
// The report of lfcompressor.
#pragma once

#include <string>

#include "lf/distribute/compress/compress.h"

namespace lf {

// Returns the text beside the progress bar: the compression ratio, such as "12.4 : 1"; "coding" as
// long as it is unknown; "verifying" when all LF images are encoded.
std::string ProgressDetail(const CompressProgress& now);

// Returns the report: compression ratio, quality, speed, skipped LF images, and the next command.
//   next  line that advises the next command; "": none
std::string CompressText(const CompressReport& report, const CompressOptions& options,
                         const std::string& next);
std::string CompressJson(const CompressReport& report, const CompressOptions& options);

// Returns text such as "a.lfs: 3 of 25 LF images are not in the store, because they are missing or
// broken; the first: ..."; "" if none is missing.
std::string MissingText(const CompressReport& report, const CompressOptions& options);

}  // namespace lf
