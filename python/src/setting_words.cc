// SPDX-License-Identifier: Apache-2.0
#include "python/src/setting_words.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <string_view>
#include <vector>

#include "python/src/errors.h"

#include "lf/core/parse_number.h"
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

// Returns a reference to a setting as an argument: filter="bicubic", fill=-1, or its name alone.
std::string Argument(std::string_view key, std::string_view value) {
  if (value.empty()) return std::string(key);
  const Setting* const setting = FindSetting(key);
  const bool is_text = setting == nullptr || setting->kind == SettingKind::kChoice ||
                       (setting->kind == SettingKind::kText && !ParseNumber(value));
  return is_text ? fmt::format("{}=\"{}\"", key, value) : fmt::format("{}={}", key, value);
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
  for (const auto& [key, text] : words)
    if (const Result<void> set = FindSetting(key)->set(text, &film); !set)
      return Error{set.error().kind, Spelled(set.error().message, Argument)};
  film.adds_opacity = true;
  return film;
}

void AddSettings(py::module_& module) {
  module.def("settings", &Settings);
  module.def("texts_of_settings", &TextsOfSettings);
}

}  // namespace lf::python
