// SPDX-License-Identifier: Apache-2.0
#include "python/src/setting_words.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "python/src/errors.h"

#include "lf/core/parse_number.h"
#include "lf/core/spelling.h"
#include "lf/render/settings/setting_table.h"

namespace lf::python {
namespace {

namespace py = pybind11;

std::string KindOf(const Setting& setting) {
  switch (setting.kind) {
    case SettingKind::kChoice:
      return "choice";
    case SettingKind::kSwitch:
      return "switch";
    case SettingKind::kWhole:
      return "whole";
    case SettingKind::kNumber:
      return "number";
    case SettingKind::kPoint:
      return "point";
    case SettingKind::kText:
      return "text";
  }
  return "";
}

// The arguments that have other names than the options of programs.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"camera", "start"}, {"output", "store"}, {"packages", "count"}};

// The arguments that are True where a command line has the option.
constexpr std::string_view kFlags[] = {"bayer",     "calibration_only", "flip_x", "flip_y",
                                       "overwrite", "resume",           "strict", "verify"};

// Returns a value as Python has it.
std::string ValueText(std::string_view key, std::string_view value) {
  const Setting* const setting = FindSetting(key);
  if (key == "guard" || (setting != nullptr && setting->kind == SettingKind::kSwitch))
    return value == "on" ? "True" : "False";
  if (setting != nullptr && setting->kind == SettingKind::kPoint) {
    std::string point = "(";
    for (const char c : value) point += c == ' ' ? std::string(", ") : std::string(1, c);
    return point + ")";
  }
  const bool is_text = setting == nullptr || setting->kind == SettingKind::kText
                           ? !ParseNumber(value)
                           : setting->kind == SettingKind::kChoice;
  return is_text ? fmt::format("\"{}\"", value) : std::string(value);
}

// Returns an option as an argument: filter="bicubic", fill=-1, resume=True, or max_images=. Before
// a colon stands its name alone, as in the messages of Python's own checks.
std::string Argument(const OptionReference& option) {
  std::string_view name = option.key;
  for (const auto& [key, other] : kOtherNames)
    if (option.key == key) name = other;
  if (!option.value.empty()) return fmt::format("{}={}", name, ValueText(option.key, option.value));
  if (option.is_heading) return std::string(name);
  const bool is_flag =
      std::find(std::begin(kFlags), std::end(kFlags), option.key) != std::end(kFlags);
  return fmt::format("{}={}", name, is_flag ? "True" : "");
}

// The rule `require` only decides how a program ends.
bool IsArgument(const Setting& setting) { return setting.key != "require"; }

py::list Settings() {
  py::list rows;
  for (const Setting& setting : SettingTable())
    if (IsArgument(setting))
      rows.append(py::make_tuple(std::string(setting.key), KindOf(setting), setting.is_optional,
                                 setting.least, setting.most));
  return rows;
}

// Returns the texts of all settings, by keys, after some were set.
SettingWords TextsOfSettings(const SettingWords& words) {
  const FilmSettings film = Take(FilmSettingsOf(words));
  SettingWords texts;
  for (const Setting& setting : SettingTable())
    if (IsArgument(setting)) texts[std::string(setting.key)] = setting.get(film);
  return texts;
}

}  // namespace

Result<FilmSettings> FilmSettingsOf(const SettingWords& words) {
  FilmSettings film;
  for (const auto& [key, text] : words) LF_RETURN_IF_ERROR(FindSetting(key)->set(text, &film));
  film.adds_opacity = true;
  return film;
}

void AddSettings(py::module_& module) {
  SetSpeller(Argument);
  module.def("settings", &Settings);
  module.def("texts_of_settings", &TextsOfSettings);
}

}  // namespace lf::python
