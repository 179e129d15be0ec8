// SPDX-License-Identifier: Apache-2.0
// The settings of a film (lf/render/settings/setting_table.h) as options of a program.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/common/help.h"

#include "lf/core/result.h"
#include "lf/render/settings/film_settings.h"
#include "lf/render/settings/setting_table.h"

namespace lf {

// Returns the words of a command line that state the settings that differ from the defaults.
//   is_wanted  returns false for settings that are left out
std::vector<std::string> WordsOf(const FilmSettings& film,
                                 const std::function<bool(const Setting&)>& is_wanted);

// Returns true for the settings for which lfpreprocessor has an option: those that packages hold,
// and those of the later render that decide what packages hold.
bool IsOfPackages(const Setting& setting);

class SettingOptions {
 public:
  SettingOptions() = default;
  // The parser holds addresses of the words.
  SettingOptions(const SettingOptions&) = delete;
  SettingOptions& operator=(const SettingOptions&) = delete;

  // Adds the options of all settings of a group of the table, with their texts there and the
  // defaults of FilmSettings. Leaves out the settings "seed", which is a common option of programs,
  // and "guard", whose option is the flag --no-guard.
  void AddTo(OptionGroup& group, SettingGroup settings);
  // Adds one option: with the text of the table, or with another one, for a program that uses the
  // setting in its own way.
  void AddTo(OptionGroup& group, std::string_view key);
  void AddTo(OptionGroup& group, std::string_view key, const std::string& text);

  // Returns the word that the command line or the default states. The option must have been added.
  const std::string& Word(std::string_view key) const { return words_.find(key)->second; }

  // Sets the settings whose options were added. kUsage: a word is no value of its setting.
  Result<void> Set(FilmSettings* film) const;

 private:
  // By keys. Maps keep their values in place.
  std::map<std::string, std::string, std::less<>> words_;
  std::map<std::string, std::vector<double>, std::less<>> points_;
};

}  // namespace lf
