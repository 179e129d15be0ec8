#include "lf/native/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

namespace lf {
namespace {

using nlohmann::json;

// A value as a message shows it: short, whatever the file holds.
std::string Shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array() && value.size() > 4) return fmt::format("a list of {}", value.size());
  constexpr size_t kLongest = 80;
  const std::string text = value.dump();
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

bool Holds(const NumberRule& rule, const json& value) {
  return value.is_number() && std::isfinite(value.get<double>()) && rule.holds(value.get<double>());
}

bool IsNumbers(const json& list, size_t count_min, size_t count_max, const NumberRule& rule) {
  return list.is_array() && list.size() >= count_min && list.size() <= count_max &&
         std::all_of(list.begin(), list.end(),
                     [&](const json& value) { return Holds(rule, value); });
}

// Levenshtein's distance.
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

Error IsNotJson(const std::filesystem::path& file, std::string_view what) {
  what.remove_prefix(std::min(what.size(), what.find("] ") + 2));  // the library's name
  return InputError(fmt::format("{}: is not JSON: {}", file.string(), what));
}

const json* JsonFields::Find(const char* key) const {
  const auto found = object_.find(key);
  return found == object_.end() || found->is_null() ? nullptr : &*found;
}

Result<std::optional<double>> JsonFields::Number(const char* key, const NumberRule& rule) const {
  const json* value = Find(key);
  if (!value) return std::optional<double>();
  if (!Holds(rule, *value)) return Wrong(key, rule.expected);
  return std::optional(value->get<double>());
}

Result<std::optional<bool>> JsonFields::Bool(const char* key) const {
  const json* value = Find(key);
  if (!value) return std::optional<bool>();
  if (!value->is_boolean()) return Wrong(key, "true or false");
  return std::optional(value->get<bool>());
}

Result<std::optional<std::string>> JsonFields::Text(const char* key) const {
  const json* value = Find(key);
  if (!value) return std::optional<std::string>();
  if (!value->is_string()) return Wrong(key, "text in quotes");
  const std::string& text = value->get_ref<const std::string&>();
  if (text.find('\0') != std::string::npos) return Wrong(key, "text without NUL characters");
  return std::optional(text);
}

Result<std::optional<std::vector<double>>> JsonFields::Numbers(const char* key, size_t count_min,
                                                               size_t count_max,
                                                               const NumberRule& rule) const {
  const json* list = Find(key);
  if (!list) return std::optional<std::vector<double>>();
  if (!IsNumbers(*list, count_min, count_max, rule)) {
    const std::string count = count_min == count_max
                                  ? fmt::format("{}", count_min)
                                  : fmt::format("{} to {}", count_min, count_max);
    return Wrong(key, fmt::format("a list of {} numbers, each {}", count, rule.expected));
  }
  return std::optional(list->get<std::vector<double>>());
}

Result<std::optional<std::vector<double>>> JsonFields::Matrix(const char* key, size_t rows_min,
                                                              size_t rows_max, size_t columns,
                                                              const NumberRule& rule) const {
  const json* rows = Find(key);
  if (!rows) return std::optional<std::vector<double>>();
  const bool is_matrix = rows->is_array() && rows->size() >= rows_min && rows->size() <= rows_max &&
                         std::all_of(rows->begin(), rows->end(), [&](const json& row) {
                           return IsNumbers(row, columns, columns, rule);
                         });
  if (!is_matrix)
    return Wrong(key,
                 fmt::format("{} lists of {} numbers, each {}", rows_max, columns, rule.expected));
  std::vector<double> values;
  values.reserve(rows->size() * columns);
  for (const json& row : *rows)
    for (const json& value : row) values.push_back(value.get<double>());
  return std::optional(std::move(values));
}

Result<void> JsonFields::CheckLfKeys(std::span<const char* const> known,
                                     std::span<const char* const> known_elsewhere,
                                     const char* elsewhere_place) const {
  const auto is_in = [](std::span<const char* const> keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  for (const auto& [key, value] : object_.items()) {
    if (!key.starts_with("lf_") || is_in(known, key)) continue;
    if (is_in(known_elsewhere, key))
      return Fault(
          fmt::format("\"{}\" stands in the wrong place: it belongs {}", key, elsewhere_place));
    constexpr size_t kLongest = 64;
    const std::string shown = key.substr(0, kLongest);
    return Fault(
        fmt::format("\"{}\" is not known: did you mean \"{}\"?", shown, Nearest(shown, known)));
  }
  return {};
}

Error JsonFields::Fault(std::string_view message) const {
  std::string place = file_.string();
  if (frame_index_) place += fmt::format(": frames[{}]", *frame_index_);
  if (!file_path_.empty()) place += fmt::format(" ({})", file_path_);
  return InputError(fmt::format("{}: {}", place, message));
}

Error JsonFields::Wrong(const char* key, std::string_view expected) const {
  const json* value = Find(key);
  return Fault(value ? fmt::format("\"{}\" is {}: expected {}", key, Shown(*value), expected)
                     : fmt::format("\"{}\" is missing: expected {}", key, expected));
}

}  // namespace lf
