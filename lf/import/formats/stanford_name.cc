// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/stanford_name.h"

#include <array>
#include <cctype>
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

// Removes the digits at the end of `text`, and returns them.
std::string_view TakeDigits(std::string_view* text) {
  const size_t end = text->find_last_not_of("0123456789") + 1;  // 0 if there are digits alone
  const std::string_view digits = text->substr(end);
  text->remove_suffix(digits.size());
  return digits;
}

// Removes `word` from the end of `text`, in upper or lower case. Returns false if it is not there.
bool TakeWord(std::string_view word, std::string_view* text) {
  if (text->size() < word.size()) return false;
  const std::string_view end = text->substr(text->size() - word.size());
  for (size_t i = 0; i < word.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(end[i])) != word[i]) return false;
  text->remove_suffix(word.size());
  return true;
}

// Returns true if a name may end before a word or number: it is empty, or ends in no letter or
// digit.
bool IsAtBoundary(std::string_view before) {
  return before.empty() || std::isalnum(static_cast<unsigned char>(before.back())) == 0;
}

// Parses a name that ends in rROW_cCOL, ROW-COL or (ROW,COL).
std::optional<StanfordName> ParseMarkedPlace(std::string_view stem) {
  const bool has_bracket = TakeWord(")", &stem);
  const std::string_view column = TakeDigits(&stem);
  std::string_view row;
  bool fits = false;
  if (has_bracket) {
    while (TakeWord(" ", &stem)) continue;
    if (!TakeWord(",", &stem)) return std::nullopt;
    row = TakeDigits(&stem);
    fits = TakeWord("(", &stem);
  } else if (TakeWord("col", &stem) || TakeWord("c", &stem)) {
    if (!TakeWord("_", &stem)) TakeWord("-", &stem);
    row = TakeDigits(&stem);
    fits = (TakeWord("row", &stem) || TakeWord("r", &stem)) && IsAtBoundary(stem);
  } else if (TakeWord("-", &stem)) {
    row = TakeDigits(&stem);
    fits = stem.empty() || stem.ends_with('-');
  }
  const std::string_view fields[] = {row, column};
  return fits ? ParseGridPlace(fields) : std::nullopt;
}

}  // namespace

std::optional<StanfordName> ParseStanfordName(std::string_view file_name) {
  if (!IsImageName(file_name)) return std::nullopt;
  std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  if (stem.ends_with('_')) stem.remove_suffix(1);
  if (const std::optional<StanfordName> name = ParseMarkedPlace(stem)) return name;
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
