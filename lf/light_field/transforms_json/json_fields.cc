// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_fields.h"

#include <fmt/format.h>
#include <simdjson.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lf {
namespace {

constexpr size_t kMostTextBytes = 4096;  // length of the longest path on Linux

using simdjson::dom::array;
using simdjson::dom::element;
using simdjson::dom::object;

// Returns a value in the form in which messages show it, shortened if it is long.
std::string Shown(const element& value) {
  if (value.is<object>()) return "an object";
  array list;
  if (value.get(list) == simdjson::SUCCESS && list.size() > 4)
    return fmt::format("a list of {}", list.size());
  constexpr size_t kLongest = 80;
  const std::string text = simdjson::minify(value);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::optional<double> NumberBy(const NumberRule& rule, const element& value) {
  double number = 0;
  if (value.get(number) != simdjson::SUCCESS || !std::isfinite(number) || !rule.holds(number))
    return std::nullopt;
  return number;
}

// Appends the numbers of a list. Returns false unless the value is a list of count_min to count_max
// numbers that satisfy the rule.
bool AppendNumbers(const element& value, size_t count_min, size_t count_max, const NumberRule& rule,
                   std::vector<double>* numbers) {
  array list;
  if (value.get(list) != simdjson::SUCCESS || list.size() < count_min || list.size() > count_max)
    return false;
  for (const element entry : list) {
    const std::optional<double> number = NumberBy(rule, entry);
    if (!number) return false;
    numbers->push_back(*number);
  }
  return true;
}

// Returns the Levenshtein distance of two texts.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

const char* Nearest(std::string_view key, std::span<const char* const> known) {
  return *std::min_element(known.begin(), known.end(), [&](const char* a, const char* b) {
    return EditDistance(key, a) < EditDistance(key, b);
  });
}

}  // namespace

std::optional<element> JsonFields::Find(const char* key) const {
  const std::string_view wanted = key;
  std::optional<element> found;
  for (const auto [name, value] : object_.object())
    if (name == wanted) found = value;
  return found && found->is_null() ? std::nullopt : found;
}

bool JsonFields::Has(const char* key) const { return Find(key).has_value(); }

std::optional<size_t> JsonFields::ListSize(const char* key) const {
  const std::optional<element> value = Find(key);
  array list;
  if (!value || value->get(list) != simdjson::SUCCESS) return std::nullopt;
  size_t count = 0;  // list.size() stops at 0xFFFFFF entries
  for (auto entry = list.begin(); entry != list.end(); ++entry) ++count;
  return count;
}

Result<std::optional<double>> JsonFields::Number(const char* key, const NumberRule& rule) const {
  const std::optional<element> value = Find(key);
  if (!value) return std::optional<double>();
  const std::optional<double> number = NumberBy(rule, *value);
  if (!number) return Wrong(key, rule.expected);
  return number;
}

Result<std::optional<std::vector<double>>> JsonFields::NumberOrNumbers(
    const char* key, size_t count, const NumberRule& rule) const {
  const std::optional<element> value = Find(key);
  if (!value) return std::optional<std::vector<double>>();
  if (const std::optional<double> number = NumberBy(rule, *value))
    return std::optional(std::vector<double>(count, *number));
  std::vector<double> numbers;
  if (!AppendNumbers(*value, count, count, rule, &numbers))
    return Wrong(key, fmt::format("{}, or a list of {} of them", rule.expected, count));
  return std::optional(std::move(numbers));
}

Result<std::optional<bool>> JsonFields::Bool(const char* key) const {
  const std::optional<element> value = Find(key);
  if (!value) return std::optional<bool>();
  bool is_true = false;
  if (value->get(is_true) != simdjson::SUCCESS) return Wrong(key, "true or false");
  return std::optional(is_true);
}

Result<std::optional<std::string>> JsonFields::Text(const char* key) const {
  const std::optional<element> value = Find(key);
  if (!value) return std::optional<std::string>();
  std::string_view text;
  if (value->get(text) != simdjson::SUCCESS) return Wrong(key, "text in quotes");
  if (text.find('\0') != std::string_view::npos) return Wrong(key, "text without NUL characters");
  if (text.size() > kMostTextBytes)
    return Wrong(key, fmt::format("text of at most {} bytes", kMostTextBytes));
  return std::optional(std::string(text));
}

Result<std::optional<std::vector<double>>> JsonFields::Numbers(const char* key, size_t count_min,
                                                               size_t count_max,
                                                               const NumberRule& rule) const {
  const std::optional<element> list = Find(key);
  if (!list) return std::optional<std::vector<double>>();
  std::vector<double> numbers;
  if (!AppendNumbers(*list, count_min, count_max, rule, &numbers)) {
    const std::string count = count_min == count_max
                                  ? fmt::format("{}", count_min)
                                  : fmt::format("{} to {}", count_min, count_max);
    return Wrong(key, fmt::format("a list of {} numbers, each {}", count, rule.expected));
  }
  return std::optional(std::move(numbers));
}

Result<std::optional<std::vector<double>>> JsonFields::Matrix(const char* key, size_t rows_min,
                                                              size_t rows_max, size_t columns,
                                                              const NumberRule& rule) const {
  const std::optional<element> value = Find(key);
  if (!value) return std::optional<std::vector<double>>();
  array rows;
  bool is_matrix =
      value->get(rows) == simdjson::SUCCESS && rows.size() >= rows_min && rows.size() <= rows_max;
  std::vector<double> numbers;
  numbers.reserve(rows_max * columns);
  if (is_matrix)
    for (const element row : rows)
      is_matrix = is_matrix && AppendNumbers(row, columns, columns, rule, &numbers);
  if (!is_matrix)
    return Wrong(key, fmt::format("{}{} lists of {} numbers, each {}",
                                  rows_min < rows_max ? fmt::format("{} to ", rows_min) : "",
                                  rows_max, columns, rule.expected));
  return std::optional(std::move(numbers));
}

Result<void> JsonFields::CheckLfKeys(std::span<const char* const> known,
                                     std::span<const char* const> known_elsewhere,
                                     const char* elsewhere_place) const {
  const auto is_in = [](std::span<const char* const> keys, std::string_view key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  for (const auto [key, value] : object_.object()) {
    if (!key.starts_with("lf_") || is_in(known, key)) continue;
    if (is_in(known_elsewhere, key))
      return Fault(fmt::format("\"{}\" is in the wrong place: move it {}", key, elsewhere_place));
    constexpr size_t kLongest = 64;
    const std::string_view shown = key.substr(0, kLongest);
    return Fault(fmt::format("\"{}\" is not a known key: did you mean \"{}\"?", shown,
                             Nearest(shown, known)));
  }
  return {};
}

Error JsonFields::Fault(std::string_view message) const {
  std::string place = file_.string();
  if (frame_index_) place += fmt::format(": {}[{}]", list_, *frame_index_);
  if (!file_path_.empty()) place += fmt::format(" ({})", file_path_);
  return InputError(fmt::format("{}: {}", place, message));
}

Error JsonFields::Wrong(const char* key, std::string_view expected) const {
  const std::optional<element> value = Find(key);
  return Fault(value ? fmt::format("\"{}\" is {}: expected {}", key, Shown(*value), expected)
                     : fmt::format("\"{}\" is missing: expected {}", key, expected));
}

}  // namespace lf
