// SPDX-License-Identifier: Apache-2.0
// The settings of a film as texts: one row for each setting, from which the options of the programs
// and the keyword arguments of Python are made. A new setting needs a member of FilmSettings, a
// row in setting_table.cc or rebin_setting_rows.cc, and code that uses it.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/result.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

enum class SettingKind {
  kChoice,  // one of some words
  kSwitch,  // "on" or "off"
  kWhole,   // a whole number
  kNumber,  // a number
  kPoint,   // three numbers, such as "0 0 1", or "auto"
  kText,    // a text of its own form, such as "noise<=0.002"
};

// The part of a film that a setting decides. A render that is resumed must have the same rays and
// pictures, and plates that are added must have the same rays.
enum class SettingRole {
  kRays,       // the rays of frames
  kPicture,    // only how pictures are made from the rays
  kMeasuring,  // only what the report of a render states
};

// Groups in which help shows settings.
enum class SettingGroup { kPicture, kQuality, kRebinning, kMeasuring };

struct Setting {
  std::string_view key;  // "lens_weights"
  SettingGroup group = SettingGroup::kPicture;
  SettingRole role = SettingRole::kRays;
  // True: packages hold the setting, and renders of packages take it from them.
  bool is_in_packages = false;
  // Returns false if no frame depends on the setting, because of the values of other settings.
  std::function<bool(const FilmSettings&)> matters = [](const FilmSettings&) { return true; };
  SettingKind kind = SettingKind::kText;
  // The word for a value in help: N in --max-images N. Empty for kChoice and kSwitch.
  std::string_view placeholder = {};
  std::vector<std::string_view> words = {};  // the words of kChoice and kSwitch
  // True: the number is unset by default, and setting it to 0 unsets it.
  bool is_optional = false;
  // Smallest and largest number of kWhole and kNumber.
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
  // The first line is a summary. The others are details; a line "word: meaning" explains a word.
  // {mode} names another setting, {mode rebin} a setting with a value; programs and Python spell
  // them in their own ways (lf/core/spelling.h).
  std::string_view text = {};

  // Returns the value as a text that `set` accepts.
  std::function<std::string(const FilmSettings&)> get = {};
  // Returns the value as files record it, if `get` may return a word that another version could
  // give another meaning; null: as get().
  std::function<std::string(const FilmSettings&)> recorded = {};
  // Sets the value. kUsage if the text is no such value; the message begins with {key}, states the
  // text that was found and what was expected, and may refer to settings as `text` does.
  std::function<Result<void>(const std::string&, FilmSettings*)> set = {};
};

// Returns the rows, group by group, in the order in which help lists them. The keys are unique.
std::span<const Setting> SettingTable();

// Returns the row with this key; null if there is none.
const Setting* FindSetting(std::string_view key);

// Keys and texts of settings, in the order of the table.
using SettingTexts = std::vector<std::pair<std::string, std::string>>;

// Returns the settings with this role that matter, as files record them. Leaves out those that are
// unset.
SettingTexts TextsOf(const FilmSettings& film, SettingRole role);

}  // namespace lf
