// SPDX-License-Identifier: Apache-2.0
// Parses numbers that come from outside: words of command lines, of files, and of names of files.
// The whole text must be a number: "12abc", "0x10", " 5" and "" are refused. The program's locale
// has no influence.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

#include "lf/core/ids.h"

namespace lf {

// Returns the number if the whole of `text` is a finite decimal number with or without sign and
// exponent, otherwise nullopt.
inline std::optional<double> ParseNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() ||
      !std::isfinite(value))
    return std::nullopt;
  return value;
}

// Returns the rate if the whole of `text` is a number, or a fraction of two numbers, as video
// programs write rates: "23.976", "24000/1001". Otherwise nullopt.
inline std::optional<double> ParseRate(std::string_view text) {
  const size_t bar = text.find('/');
  if (bar == std::string_view::npos) return ParseNumber(text);
  const auto above = ParseNumber(text.substr(0, bar)), below = ParseNumber(text.substr(bar + 1));
  if (!above || !below || *below == 0) return std::nullopt;
  return std::isfinite(*above / *below) ? std::optional(*above / *below) : std::nullopt;
}

// Returns the number if the whole of `text` consists of decimal digits, with a minus before them if
// it is negative, and the number fits into the type, otherwise nullopt.
template <std::integral Whole>
std::optional<Whole> ParseWhole(std::string_view text) {
  Whole value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Returns the number if the whole of `text` is one that a frame may have, otherwise nullopt.
inline std::optional<uint32_t> ParseFrameNumber(std::string_view text) {
  const std::optional<uint32_t> number = ParseWhole<uint32_t>(text);
  return number && *number <= kLargestFrameNumber ? number : std::nullopt;
}

}  // namespace lf
