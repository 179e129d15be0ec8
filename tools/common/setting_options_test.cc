// SPDX-License-Identifier: Apache-2.0
#include "tools/common/setting_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lf/core/spelling.h"
#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

// Returns the settings that the command line states.
Result<FilmSettings> Parsed(const std::vector<std::string>& words) {
  CLI::App app;
  OptionGroup group(app, "All");
  SettingOptions options;
  for (const Setting& setting : SettingTable()) options.AddTo(group, setting.key);
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    return UsageError(error.what());
  }
  FilmSettings film;
  LF_RETURN_IF_ERROR(options.Set(&film));
  return film;
}

TEST(SettingOptions, SayWhatTheTableSays) {
  for (const Setting& setting : SettingTable()) {
    const std::string value = testing::AnotherOf(setting);
    FilmSettings expected;
    ASSERT_TRUE(setting.set(value, &expected)) << setting.key;
    std::vector<std::string> words = {CommandLineOption({setting.key})};
    if (setting.kind == SettingKind::kPoint)
      for (const std::string& number : CLI::detail::split(value, ' ')) words.push_back(number);
    else
      words.push_back(value);
    const Result<FilmSettings> film = Parsed(words);
    ASSERT_TRUE(film) << film.error().message;
    for (const Setting& other : SettingTable())
      EXPECT_EQ(other.get(*film), other.get(expected)) << setting.key << " " << other.key;
    EXPECT_NE(setting.get(*film), setting.get(FilmSettings())) << setting.key;
  }
  const Result<FilmSettings> none = Parsed({});
  ASSERT_TRUE(none);
  for (const Setting& setting : SettingTable())
    EXPECT_EQ(setting.get(*none), setting.get(FilmSettings())) << setting.key;
}

TEST(SettingOptions, WrongValuesNameTheOption) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--mode", "collected"},
                                             {"--fill", "-1"},
                                             {"--max-angle", "181"},
                                             {"--alpha", "0x1"},
                                             {"--max-rays", "12"},
                                             {"--stop-when", "noise<0"},
                                             {"--lens-sets", "9"},
                                             {"--r-st", "-1"},
                                             {"--slab-forward", "0", "x", "1"}}) {
    const Result<FilmSettings> film = Parsed(words);
    ASSERT_FALSE(film) << words[0];
    const std::string message = Spelled(film.error().message, CommandLineOption);
    EXPECT_NE(message.find(words[0]), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lf
