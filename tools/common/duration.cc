// SPDX-License-Identifier: Apache-2.0
#include "tools/common/duration.h"

#include <fmt/format.h>

#include <cctype>
#include <optional>

#include "lf/core/parse_number.h"

namespace lf {

Result<double> ParseDuration(const std::string& text, const std::string& option) {
  const auto error = [&] {
    return UsageError(fmt::format("{} '{}': expected a time such as 30s, 10m or 1h, at most 1e9 s",
                                  option, text));
  };
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) == 0) return error();
  const size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::optional<double> value = ParseNumber(text.substr(0, digits));
  const std::string unit = text.substr(digits);
  const double unit_s = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (!value || unit_s == 0 || !(*value * unit_s <= 1e9)) return error();
  return *value * unit_s;
}

}  // namespace lf
