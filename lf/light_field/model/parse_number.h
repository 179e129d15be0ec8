// SPDX-License-Identifier: Apache-2.0
// Parses numbers in text files, for the readers of calibrations.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

namespace lf {

// Returns the number if the whole of `text` is a finite decimal number with or without sign and
// exponent, otherwise nullopt. The program's locale has no influence.
inline std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() ||
      !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace lf
