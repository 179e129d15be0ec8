// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/shard.h"

#include <charconv>

namespace lf {

std::optional<Shard> ShardOf(std::string_view text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  if (number.ec != std::errc{} || number.ptr == end || *number.ptr != '/') return std::nullopt;
  const auto count = std::from_chars(number.ptr + 1, end, shard.count);
  if (count.ec != std::errc{} || count.ptr != end || shard.number < 1 ||
      shard.number > shard.count || shard.count > Shard::kMost)
    return std::nullopt;
  return shard;
}

}  // namespace lf
