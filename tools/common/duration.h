// Parses times as people write them: "30s", "10m", "1.5h", "0".
#pragma once

#include <string>

#include "lf/core/result.h"

namespace lf {

// Returns seconds, which are also the unit of a bare number. kUsage: the message names the option.
Result<double> ParseDuration(const std::string& text, const std::string& option);

}  // namespace lf
