// SPDX-License-Identifier: Apache-2.0
#include "lf/core/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "lf/core/parse_number.h"

namespace lf {

Result<size_t> ParseByteSize(const std::string& text, const std::string& name) {
  const auto error = [&] {
    return UsageError(fmt::format(
        "{} '{}': expected a size from 1 byte to less than 1048576T, such as 8G, 512M or 1.5G",
        name, text));
  };
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) == 0) return error();
  const size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  std::optional<double> value = ParseNumber(text.substr(0, digits));
  if (!value) return error();
  std::string unit = text.substr(digits);
  if (!unit.empty() && (unit.back() == 'B' || unit.back() == 'b')) unit.pop_back();
  if (unit.size() > 1) return error();
  if (!unit.empty()) {
    const std::string units = "KMGT";
    const size_t power = units.find(static_cast<char>(std::toupper(unit[0])));
    if (power == std::string::npos) return error();
    *value *= std::pow(1024.0, static_cast<double>(power + 1));
  }
  if (!(*value >= 1 && *value < 0x1p60)) return error();
  return static_cast<size_t>(*value);
}

Result<uint64_t> ParseCount(const std::string& text, const std::string& name) {
  const Error error = UsageError(
      fmt::format("{} '{}': expected a whole number, such as 250000, 250k or 1.5M", name, text));
  constexpr double kMost = 0x1p53;  // larger whole numbers are not exact
  const size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  std::optional<double> value = ParseNumber(text.substr(0, digits));
  const std::string unit = text.substr(digits), units = "KMGT";
  if (!value || unit.size() > 1) return error;
  if (!unit.empty()) {
    const size_t power =
        units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(unit[0]))));
    if (power == std::string::npos) return error;
    *value *= std::pow(1000.0, static_cast<double>(power + 1));
  }
  if (!(*value < kMost) || *value != std::floor(*value)) return error;
  return static_cast<uint64_t>(*value);
}

Result<double> ParseDuration(const std::string& text, const std::string& name) {
  const auto error = [&] {
    return UsageError(
        fmt::format("{} '{}': expected a time such as 30s, 10m or 1h, at most 1e9 s", name, text));
  };
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) == 0) return error();
  const size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::optional<double> value = ParseNumber(text.substr(0, digits));
  const std::string unit = text.substr(digits);
  const double unit_s = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (!value || unit_s == 0 || !(*value * unit_s <= 1e9)) return error();
  return *value * unit_s;
}

std::string ShortNumber(double value) {
  constexpr const char* kPrefixes[] = {"", "k", "M", "G", "T"};
  int prefix = 0;
  for (; value >= 1000 && prefix < 4; ++prefix) value /= 1000;
  return fmt::format("{:.3g} {}", value, kPrefixes[prefix]);
}

std::string ShortDuration(double seconds) {
  const auto whole = static_cast<int64_t>(std::llround(std::max(0.0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace lf
