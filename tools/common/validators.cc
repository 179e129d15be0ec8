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
        const bool is_minus_zero =
            word.size() > 1 && word[0] == '-' && word.find_first_not_of('0', 1) == word.npos;
        const std::optional<Whole> number = is_minus_zero ? Whole{0} : ParseWhole<Whole>(word);
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

CLI::Validator Rate() {
  return CLI::Validator(
      [](std::string& word) -> std::string {
        const std::optional<double> rate = ParseRate(word);
        if (!rate) return fmt::format("expected a number, found '{}'", word);
        if (word.find('/') != std::string::npos) word = fmt::format("{}", *rate);
        return {};
      },
      "");
}

CLI::Validator NotEmpty() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        return word.empty() ? "expected a value, found nothing: is a variable of the shell unset?"
                            : "";
      },
      "");
}

}  // namespace lf
