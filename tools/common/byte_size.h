// "8G", "512M", "1.5g", "100000": memory as people write it.
#pragma once

#include <cstddef>
#include <string>

#include "lf/core/result.h"

namespace lf {

// Powers of 1024. kUsage names the option.
Result<size_t> ParseByteSize(const std::string& text, const std::string& option);

}  // namespace lf
