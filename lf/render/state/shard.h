// A part of the LF images of a render, for frames that are too much for one machine. The sum of the
// plates of all shards is, bit by bit, the plate of the render that is not divided.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lf {

// Shard `number` (1 to `count`) of `count` shards has the LF images at every count-th place of the
// order.
struct Shard {
  static constexpr uint32_t kMost = 100000;
  uint32_t number = 1;
  uint32_t count = 1;

  bool Holds(uint32_t place) const { return place % count == number - 1; }
  std::string Text() const { return std::to_string(number) + "/" + std::to_string(count); }
  // Name of its folder.
  std::string Name() const {
    return "shard_" + std::to_string(number) + "_of_" + std::to_string(count);
  }
};

// Parses a text such as "2/5"; none for any other text.
std::optional<Shard> ShardOf(std::string_view text);

}  // namespace lf
