// SPDX-License-Identifier: Apache-2.0
// Parses large numbers of things as people write them: "3M", "1.5k", "250000".
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/result.h"

namespace lf {

// Returns the number. The units k, M, G and T, in capitals or not, are powers of 1000. kUsage: the
// text is no number, or the number is not whole, below 0 or at least 2^53; the message begins with
// `option`, such as "--max-rays".
Result<uint64_t> ParseCount(const std::string& text, const std::string& option);

}  // namespace lf
