// SPDX-License-Identifier: Apache-2.0
// Finds a value of an enumeration by its name in options and files.
#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>

namespace lf {

// Returns the value among `values` whose NameOf() is `name`; nullopt if there is none.
template <class Value>
std::optional<Value> ValueNamed(std::string_view name, std::initializer_list<Value> values) {
  for (const Value value : values)
    if (name == NameOf(value)) return value;
  return std::nullopt;
}

}  // namespace lf
