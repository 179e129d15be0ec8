// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_words.h"

#include <fmt/format.h>

#include <cmath>

namespace lf {

Result<std::string> ExportWords::Word(const char* name) {
  if (!Advance()) return Fault(fmt::format("the file ends before {}", name));
  return std::string(words_.Word());
}

Result<double> ExportWords::Number(const char* name, double most) {
  if (!Advance()) return Fault(fmt::format("the file ends before {}", name));
  LF_ASSIGN_OR_RETURN(const double number, words_.Number(name));
  if (!(std::abs(number) <= most))
    return Fault(fmt::format("{} is {:g}: expected a number within +-{:g}", name, number, most));
  return number;
}

Result<std::vector<double>> ExportWords::Numbers(const char* name, size_t count, double most) {
  std::vector<double> numbers;
  while (numbers.size() < count) {
    LF_ASSIGN_OR_RETURN(const double number, Number(name, most));
    numbers.push_back(number);
  }
  return numbers;
}

Result<std::vector<double>> ExportWords::NumbersOfLine(const char* names, size_t count,
                                                       double most) {
  std::vector<double> numbers;
  while (numbers.size() < count && !words_.AtLineEnd()) {
    LF_ASSIGN_OR_RETURN(const double number, Number(names, most));
    numbers.push_back(number);
  }
  if (numbers.size() < count || !words_.AtLineEnd())
    return Fault(fmt::format("has {} than {} numbers: expected {}",
                             numbers.size() < count ? "fewer" : "more", count, names));
  return numbers;
}

}  // namespace lf
