// SPDX-License-Identifier: Apache-2.0
// Parses times as people write them: "30s", "10m", "1.5h", "0".
#pragma once

#include <string>

#include "lf/core/result.h"

namespace lf {

// Returns the time in seconds. The text is a number, alone (seconds) or followed by s, m or h.
// kUsage: the text has another form, or the time exceeds 1e9 s; the message begins with `option`,
// such as "--dump-every".
Result<double> ParseDuration(const std::string& text, const std::string& option);

}  // namespace lf
