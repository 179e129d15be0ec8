// SPDX-License-Identifier: Apache-2.0
#include "tools/common/validators.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <string>

namespace lf {

CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](std::string& word) -> std::string {
        uint64_t number = 0;
        const char* const end = word.data() + word.size();
        const auto [rest, error] = std::from_chars(word.data(), end, number);
        if (error != std::errc{} || rest != end)
          return fmt::format("expected a whole number from 0 to {}, found '{}'", UINT64_MAX, word);
        // Removes leading zeros, with which CLI11 would read an octal number.
        word = fmt::format("{}", number);
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
