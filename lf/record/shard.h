// A part of the LF images of a render, for a few frames that are too much for one machine: the
// plates of all shards add to the frames' plates, to the bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lf {

// One of `count`, from 1 on: it has the LF images at every count-th place of the order.
struct Shard {
  static constexpr uint32_t kMost = 100000;
  uint32_t number = 1;
  uint32_t count = 1;

  bool Holds(uint32_t place) const { return place % count == number - 1; }
  std::string Text() const { return std::to_string(number) + "/" + std::to_string(count); }
  // Of folders.
  std::string Name() const {
    return "shard_" + std::to_string(number) + "_of_" + std::to_string(count);
  }
};

// Of "2/5"; none of other texts.
std::optional<Shard> ShardOf(std::string_view text);

}  // namespace lf
