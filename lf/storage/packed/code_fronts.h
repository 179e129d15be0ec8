// SPDX-License-Identifier: Apache-2.0
// The fronts of an encoded image: its first bytes, which are a smaller picture of it. A store keeps
// the length and the checksum of each front, so that it is read and checked without the rest
// (doc/formats/packed_store.md, "Tables"). Internal to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lf {

struct CodeFront {
  uint64_t bytes = 0;  // length of the front
  uint64_t hash = 0;   // HashBytes() of the front
};

// Returns the column `fronts` for the fronts of `code` that end at `ends`: for each front its
// length and its hash, in 8 bytes each, the least significant first.
std::string CodeOfFronts(std::string_view code, std::span<const uint64_t> ends);

// Returns the fronts that the column states, shortest first; nullopt if it is damaged: it has a
// wrong size, or lengths do not ascend or exceed `most_bytes`.
std::optional<std::vector<CodeFront>> FrontsOfCode(std::string_view fronts, uint64_t most_bytes);

}  // namespace lf
