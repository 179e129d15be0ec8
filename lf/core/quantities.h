// SPDX-License-Identifier: Apache-2.0
// Quantities as people write and read them: "8G" of memory, "3M" rays, "30s"; "2 min 5 s".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "lf/core/result.h"

namespace lf {

// The first three functions return kUsage if the text is no such quantity; the message begins with
// `name`, such as "{memory}", and states the text and what was expected.

// Returns a number of bytes, such as of "8G", "512M", "1.5g" or "100000". The units K, M, G and T
// are powers of 1024. The size must be in [1, 2^60) bytes.
Result<size_t> ParseByteSize(const std::string& text, const std::string& name);

// Returns a number of things, such as of "3M", "1.5k" or "250000". The units k, M, G and T, in
// capitals or not, are powers of 1000. The number must be whole, and in [0, 2^53).
Result<uint64_t> ParseCount(const std::string& text, const std::string& name);

// Returns a time in seconds, such as of "30s", "10m", "1.5h" or "0". The text is a number, alone
// (seconds) or followed by s, m or h. The time must not exceed 1e9 s.
Result<double> ParseDuration(const std::string& text, const std::string& name);

// Returns a number with an SI prefix, such as "1.5 G", "320 M" or "12 k", to which a unit can be
// appended. A number below 1000 ends in a blank instead: "12 ".
std::string ShortNumber(double value);
// Returns a time, such as "3 h 20 min", "2 min 5 s" or "14 s".
std::string ShortDuration(double seconds);

}  // namespace lf
