// SPDX-License-Identifier: Apache-2.0
#include "tools/common/setting_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/common/validators.h"

#include "lf/core/check.h"
#include "lf/core/spelling.h"

namespace lf {
namespace {

void AddRange(CLI::Option* option, const Setting& setting) {
  if (setting.kind == SettingKind::kWhole && std::isfinite(setting.most))
    option->check(
        CLI::Range(static_cast<int64_t>(setting.least), static_cast<int64_t>(setting.most)));
  else if (std::isfinite(setting.most))
    option->check(CLI::Range(setting.least, setting.most));
  else if (setting.kind == SettingKind::kNumber)
    option->check(CLI::NonNegativeNumber);
}

}  // namespace

std::vector<std::string> WordsOf(const FilmSettings& film,
                                 const std::function<bool(const Setting&)>& is_wanted) {
  std::vector<std::string> words;
  for (const Setting& setting : SettingTable()) {
    const std::string value = setting.get(film);
    if (value == setting.get(FilmSettings()) || !is_wanted(setting)) continue;
    words.push_back(CommandLineOption({setting.key, setting.key == "guard" ? value : ""}));
    if (setting.kind == SettingKind::kPoint)
      for (const auto& number : CLI::detail::split(value, ' ')) words.push_back(number);
    else if (setting.key != "guard")
      words.push_back(value);
  }
  return words;
}

bool IsOfPackages(const Setting& setting) {
  constexpr std::string_view kOfLaterRender[] = {"mode", "interpolation", "lens_weights", "guard",
                                                 "estimator"};
  return setting.is_in_packages || std::find(std::begin(kOfLaterRender), std::end(kOfLaterRender),
                                             setting.key) != std::end(kOfLaterRender);
}

void SettingOptions::AddTo(OptionGroup& group, SettingGroup settings) {
  for (const Setting& setting : SettingTable())
    if (setting.group == settings && setting.key != "seed" && setting.key != "guard")
      AddTo(group, setting.key);
}

void SettingOptions::AddTo(OptionGroup& group, std::string_view key) {
  AddTo(group, key, Spelled(FindSetting(key)->text, CommandLineOption));
}

void SettingOptions::AddTo(OptionGroup& group, std::string_view key, const std::string& text) {
  const Setting* const setting = FindSetting(key);
  LF_CHECK(setting != nullptr);
  const std::string names = CommandLineOption({key, setting->placeholder});
  if (setting->kind == SettingKind::kPoint) {
    group.Add(names, points_[std::string(key)], text)->expected(3);
    return;
  }
  std::string& word = words_[std::string(key)];
  word = setting->get(FilmSettings());
  if (setting->kind == SettingKind::kChoice || setting->kind == SettingKind::kSwitch)
    group.AddChoice(names, word, {setting->words.begin(), setting->words.end()}, text);
  else if (setting->kind == SettingKind::kText)
    group.Add(names, word, text)->check(NotEmpty());
  else
    AddRange(
        group.AddNumber(names, word,
                        setting->kind == SettingKind::kWhole ? OptionWords::kWholeNumbersFromZero
                                                             : OptionWords::kNumbers,
                        text),
        *setting);
}

Result<void> SettingOptions::Set(FilmSettings* film) const {
  const auto set = [film](std::string_view key, const std::string& text) {
    return FindSetting(key)->set(text, film);
  };
  for (const auto& [key, word] : words_) LF_RETURN_IF_ERROR(set(key, word));
  for (const auto& [key, numbers] : points_)
    if (!numbers.empty()) LF_RETURN_IF_ERROR(set(key, fmt::format("{}", fmt::join(numbers, " "))));
  return {};
}

}  // namespace lf
