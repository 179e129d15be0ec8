// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lf {

void JsonText::AddNumber(double x) {
  // "-0" would be read as an integer and lose its sign.
  if (x == 0 && std::signbit(x))
    Add("-0.0");
  else
    Add("{}", x);
}

void JsonText::AddNumbers(std::span<const double> list) {
  Add("[");
  for (size_t i = 0; i < list.size(); ++i) {
    if (i > 0) Add(", ");
    AddNumber(list[i]);
  }
  Add("]");
}

void JsonText::AddMatrix(std::span<const double> values, size_t columns) {
  Add("[");
  for (size_t i = 0; i < values.size(); i += columns) {
    if (i > 0) Add(", ");
    AddNumbers(values.subspan(i, columns));
  }
  Add("]");
}

Result<void> JsonText::AddString(const std::string& string) {
  try {
    text_ += nlohmann::json(string).dump();
  } catch (const nlohmann::json::exception&) {
    return OutputError(fmt::format("the name \"{}\" is not UTF-8: rename the file", string));
  }
  return {};
}

}  // namespace lf
