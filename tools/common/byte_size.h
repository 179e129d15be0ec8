// SPDX-License-Identifier: Apache-2.0
// Parses memory sizes as people write them: "8G", "512M", "1.5g", "100000".
#pragma once

#include <cstddef>
#include <string>

#include "lf/core/result.h"

namespace lf {

// Returns the number of bytes. The units K, M, G and T are powers of 1024. kUsage: the text is no
// size, or the size is not in [1, 2^60) bytes; the message begins with `option`, such as
// "--memory".
Result<size_t> ParseByteSize(const std::string& text, const std::string& option);

}  // namespace lf
