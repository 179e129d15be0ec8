// SPDX-License-Identifier: Apache-2.0
// Sizes of memory as text for people.
#pragma once

#include <cstdint>
#include <string>

namespace lf {

// Returns a size in whole MiB, rounded down; below 1 MiB in whole KiB, and below 1 KiB in bytes:
// "12 MiB", "1 KiB", "100 bytes", "1 byte".
std::string ByteText(uint64_t bytes);

}  // namespace lf
