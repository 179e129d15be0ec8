// SPDX-License-Identifier: Apache-2.0
#include "tools/common/byte_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "lf/core/parse_number.h"

namespace lf {

Result<size_t> ParseByteSize(const std::string& text, const std::string& option) {
  const auto error = [&] {
    return UsageError(fmt::format(
        "{} '{}': expected a size from 1 byte to less than 1048576T, such as 8G, 512M or 1.5G",
        option, text));
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

}  // namespace lf
