// SPDX-License-Identifier: Apache-2.0
// A shard: a part of the LF images of a render whose frames are too much work for one machine. The
// sum of the plates of all shards is bit-identical to the plate of an undivided render.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lf {

// Shard `number` of `count` shards, from 1 to `count`, has the LF images at the ranks number - 1,
// number - 1 + count, ... of the order.
struct Shard {
  static constexpr uint32_t kMost = 100000;
  uint32_t number = 1;
  uint32_t count = 1;

  bool Holds(uint32_t rank) const { return rank % count == number - 1; }
  std::string Text() const { return std::to_string(number) + "/" + std::to_string(count); }
  // Returns the name of the shard's folder.
  std::string Name() const {
    return "shard_" + std::to_string(number) + "_of_" + std::to_string(count);
  }
};

// Parses a text such as "2/5"; returns nullopt for any other text.
std::optional<Shard> ShardOf(std::string_view text);

}  // namespace lf
