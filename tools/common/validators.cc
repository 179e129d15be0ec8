// SPDX-License-Identifier: Apache-2.0
#include "tools/common/validators.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

template <typename Whole>
CLI::Validator WholeNumberOf(const char* expected) {
  return CLI::Validator(
      [expected](std::string& word) -> std::string {
        const std::optional<Whole> number = ParseWhole<Whole>(word);
        if (!number) return fmt::format("expected {}, found '{}'", expected, word);
        word = fmt::format("{}", *number);
        return {};
      },
      "");
}

}  // namespace

CLI::Validator Number() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        return ParseNumber(word) ? "" : fmt::format("expected a number, found '{}'", word);
      },
      "");
}

CLI::Validator WholeNumber() { return WholeNumberOf<int64_t>("a whole number"); }
CLI::Validator WholeNumberFromZero() { return WholeNumberOf<uint64_t>("a whole number from 0"); }

CLI::Validator NotEmpty() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        return word.empty() ? "expected a value, found nothing: is a variable of the shell unset?"
                            : "";
      },
      "");
}

}  // namespace lf
