// SPDX-License-Identifier: Apache-2.0
#include "tools/common/count.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "lf/core/parse_number.h"

namespace lf {

Result<uint64_t> ParseCount(const std::string& text, const std::string& option) {
  const Error error = UsageError(
      fmt::format("{} '{}': expected a whole number, such as 250000, 250k or 1.5M", option, text));
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

}  // namespace lf
