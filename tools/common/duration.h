// "30s", "10m", "1.5h", "0": time as people write it.
#pragma once

#include <string>

#include "lf/core/result.h"

namespace lf {

// In seconds; a bare number is seconds. kUsage names the option.
Result<double> ParseDuration(const std::string& text, const std::string& option);

}  // namespace lf
