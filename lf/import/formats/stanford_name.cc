// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/stanford_name.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "lf/light_field/model/image_files.h"

namespace lf {
namespace {

constexpr double kLargest_mm = 1e12;

std::optional<int> ParseIndex(std::string_view text) {
  int value = 0;
  if (text.empty()) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text[0] == '-')
    return std::nullopt;
  return value;
}

std::optional<double> ParseDecimal(std::string_view text) {
  if (text.find_first_not_of("-.0123456789") != std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= kLargest_mm))
    return std::nullopt;
  return value;
}

// Parses two fields of a name as ROW and COL.
std::optional<StanfordName> ParseGridPlace(const std::string_view* fields) {
  const std::optional<int> row = ParseIndex(fields[0]);
  const std::optional<int> column = ParseIndex(fields[1]);
  if (!row || !column) return std::nullopt;
  return StanfordName{*row, *column, std::nullopt, std::nullopt};
}

// Parses four fields of a name as ROW, COL, Y and X.
std::optional<StanfordName> ParsePosition(const std::string_view* fields) {
  std::optional<StanfordName> name = ParseGridPlace(fields);
  const std::optional<double> y_mm = ParseDecimal(fields[2]);
  const std::optional<double> x_mm = ParseDecimal(fields[3]);
  if (!name || !y_mm || !x_mm) return std::nullopt;
  name->position = StanfordName::Position{*y_mm, *x_mm};
  return name;
}

}  // namespace

std::optional<StanfordName> ParseStanfordName(std::string_view file_name) {
  if (!IsImageName(file_name)) return std::nullopt;
  std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  if (stem.ends_with('_')) stem.remove_suffix(1);
  // Splits off at most the last six fields. The rest is NAME, which may be empty or missing.
  std::array<std::string_view, 6> fields;
  size_t count = 0;
  for (bool is_split = true; is_split && count < fields.size(); ++count) {
    const size_t underscore = stem.rfind('_');
    is_split = underscore != std::string_view::npos;
    fields[fields.size() - 1 - count] = is_split ? stem.substr(underscore + 1) : stem;
    if (is_split) stem.remove_suffix(stem.size() - underscore);
  }
  if (count == 6) {
    std::optional<StanfordName> name = ParsePosition(&fields[0]);
    const std::optional<double> focal_mm = ParseDecimal(fields[4]);
    const std::optional<double> sensor_width_mm = ParseDecimal(fields[5]);
    if (name && focal_mm.value_or(0) > 0 && sensor_width_mm.value_or(0) > 0) {
      name->lens = StanfordName::Lens{*focal_mm, *sensor_width_mm};
      return name;
    }
  }
  if (count >= 4)
    if (const std::optional<StanfordName> name = ParsePosition(&fields[2])) return name;
  return count >= 2 ? ParseGridPlace(&fields[4]) : std::nullopt;
}

std::optional<int> NumberOfHciName(std::string_view file_name) {
  constexpr std::string_view kBegin = "input_Cam";
  if (!file_name.starts_with(kBegin) || !IsImageName(file_name)) return std::nullopt;
  const std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  return stem.size() > kBegin.size() ? ParseIndex(stem.substr(kBegin.size())) : std::nullopt;
}

}  // namespace lf
