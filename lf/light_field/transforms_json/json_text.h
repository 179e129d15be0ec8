// SPDX-License-Identifier: Apache-2.0
// The text of a JSON file while it is written. Used by the writers of calibrations and camera
// paths.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "lf/core/result.h"

namespace lf {

// Appends to the text. Numbers are written with the fewest digits (at most 17) that are read back
// as the same double.
class JsonText {
 public:
  template <class... Args>
  void Add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }
  void AddNumber(double x);
  // Adds a list [x, y, ...].
  void AddNumbers(std::span<const double> list);
  // Adds a list of rows, each with `columns` numbers.
  void AddMatrix(std::span<const double> values, size_t columns);
  // Adds a string in quotation marks. kOutput if it is not UTF-8, which JSON requires.
  Result<void> AddString(const std::string& string);

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace lf
