// SPDX-License-Identifier: Apache-2.0
// Internal to lf/render/settings. Makes the rows of the table of settings (setting_table.h).
//
// Each function completes a row, which states key, texts and limits, by kind, get and set. `member`
// returns the member of FilmSettings that the row is about; LF_MEMBER(mode) makes such a function.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/parse_number.h"
#include "lf/render/settings/setting_table.h"

#define LF_MEMBER(name) \
  [](auto& film) -> auto& { return film.name; }

namespace lf {

inline Error Refused(const Setting& setting, const std::string& found,
                     const std::string& expected) {
  return UsageError(fmt::format("{{{} {}}}: expected {}", setting.key, found, expected));
}

template <class Value>
using Words = std::vector<std::pair<std::string_view, Value>>;

// Returns values with their names.
template <class Value>
Words<Value> Named(std::initializer_list<Value> values) {
  Words<Value> words;
  for (const Value value : values) words.emplace_back(NameOf(value), value);
  return words;
}

template <class Member, class Value>
Setting Choice(Setting row, Member member, Words<Value> words) {
  row.kind = SettingKind::kChoice;
  for (const auto& [word, value] : words) row.words.push_back(word);
  row.get = [member, words](const FilmSettings& film) {
    return std::string(std::find_if(words.begin(), words.end(), [&](const auto& word) {
                         return word.second == member(film);
                       })->first);
  };
  row.set = [member, words, row](const std::string& text, FilmSettings* film) -> Result<void> {
    for (const auto& [word, value] : words)
      if (word == text) {
        member(*film) = value;
        return {};
      }
    return Refused(row, text, fmt::format("one of {}", fmt::join(row.words, ", ")));
  };
  return row;
}

template <class Member>
Setting Switch(Setting row, Member member) {
  row = Choice(std::move(row), member, Words<bool>{{"on", true}, {"off", false}});
  row.kind = SettingKind::kSwitch;
  return row;
}

// Returns the number of a text, if it is one from row.least to row.most.
template <class Number>
std::optional<Number> NumberOf(const Setting& row, const std::string& text) {
  std::optional<Number> number;
  if constexpr (std::is_integral_v<Number>)
    number = ParseWhole<Number>(text);
  else
    number = ParseNumber(text);
  if (!number || static_cast<double>(*number) < row.least ||
      static_cast<double>(*number) > row.most)
    return std::nullopt;
  return number;
}

inline std::string RangeOf(const Setting& row) {
  const char* const kind = row.kind == SettingKind::kWhole ? "a whole number" : "a number";
  if (std::isfinite(row.most)) return fmt::format("{} from {} to {}", kind, row.least, row.most);
  return fmt::format("{} from {}", kind, row.least);
}

template <class Number, class Get, class Set>
Setting Numeric(Setting row, Get get, Set set) {
  row.kind = std::is_integral_v<Number> ? SettingKind::kWhole : SettingKind::kNumber;
  row.get = [get](const FilmSettings& film) { return fmt::format("{}", Number{get(film)}); };
  row.set = [row, set](const std::string& text, FilmSettings* film) -> Result<void> {
    const std::optional<Number> number = NumberOf<Number>(row, text);
    if (!number) return Refused(row, text, RangeOf(row));
    set(*film, *number);
    return {};
  };
  return row;
}

// A number that the member holds as it is.
template <class Member>
Setting Plain(Setting row, Member member) {
  using Number = std::remove_cvref_t<decltype(member(std::declval<FilmSettings&>()))>;
  return Numeric<Number>(std::move(row), member,
                         [member](FilmSettings& film, Number number) { member(film) = number; });
}

// A number that is 0 if the optional member is unset.
//   number, value  convert the member to the number, and back
template <class Member, class ToNumber = std::identity, class ToValue = std::identity>
Setting ZeroIfUnset(Setting row, Member member, ToNumber number = {}, ToValue value = {}) {
  using Value =
      typename std::remove_cvref_t<decltype(member(std::declval<FilmSettings&>()))>::value_type;
  row.is_optional = true;
  return Numeric<Value>(
      std::move(row),
      [member, number](const FilmSettings& film) {
        return member(film) ? number(*member(film)) : Value{0};
      },
      [member, value](FilmSettings& film, Value given) {
        member(film).reset();
        if (given > 0) member(film) = value(given);
      });
}

// A point or a direction; "auto" if the member is unset.
template <class Member>
Setting Point(Setting row, Member member) {
  row.kind = SettingKind::kPoint;
  row.get = [member](const FilmSettings& film) {
    const std::optional<Vec3>& point = member(film);
    return point ? fmt::format("{} {} {}", point->x(), point->y(), point->z()) : "auto";
  };
  row.set = [member, row](const std::string& text, FilmSettings* film) -> Result<void> {
    if (text == "auto") {
      member(*film).reset();
      return {};
    }
    std::vector<double> numbers;
    for (size_t begin = 0; begin <= text.size();) {
      const size_t end = std::min(text.find(' ', begin), text.size());
      const std::optional<double> number = ParseNumber(text.substr(begin, end - begin));
      if (!number) break;
      numbers.push_back(*number);
      begin = end + 1;
    }
    if (numbers.size() != 3 || text.ends_with(' ')) return Refused(row, text, "three numbers");
    member(*film) = Vec3(numbers.data());
    return {};
  };
  return row;
}

template <class Member>
Setting Rule(Setting row, Member member) {
  row.get = [member](const FilmSettings& film) { return TextOf(member(film)); };
  row.set = [member, row](const std::string& text, FilmSettings* film) -> Result<void> {
    LF_ASSIGN_OR_RETURN(member(*film), ParseStopRule(text, fmt::format("{{{}}}", row.key)));
    return {};
  };
  return row;
}

// Adds the rows of kRebinning (rebin_setting_rows.cc).
void AddRebinRows(std::vector<Setting>& rows);

}  // namespace lf
