// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/tables/settings_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace lf {
namespace {

constexpr DatabaseFormat kSettingsFormat = {"test file", 0x4C465454, 1};

TEST(Settings, AreReadAsWhatTheyShouldBe) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("lf_settings_test." + std::to_string(::getpid()));
  {
    Database database = Database::Create(path, kSettingsFormat).value();
    ASSERT_TRUE(database.Execute(kSettingsTable));
    ASSERT_TRUE(WriteSettings({{"three", "1 2.5 -3"}, {"big", "18446744073709551615"}, {"w", "b"}},
                              &database));
  }
  Database database = Database::Open(path, kSettingsFormat, {kSettingsTable}).value();
  const Settings settings = Settings::Read(database, "test file").value();
  EXPECT_EQ(settings.Text("three"), "1 2.5 -3");
  EXPECT_EQ(settings.Text("none"), "");
  EXPECT_EQ(*settings.Numbers("three", 3, 3), (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(*settings.Whole("big"), UINT64_MAX);
  constexpr const char* kWords[] = {"a", "b"};
  EXPECT_EQ(*settings.Word("w", kWords), 1);
  for (const std::string& message :
       {settings.Numbers("three", 1, 2).error().message,
        settings.Number("none", 0, 1).error().message, settings.Whole("three").error().message,
        settings.Word("big", kWords).error().message}) {
    EXPECT_TRUE(message.starts_with(path.string() + ": is a damaged test file: ")) << message;
  }
  EXPECT_NE(settings.Number("big", 0, 1).error().message.find("setting big is '1844"),
            std::string::npos);
  EXPECT_NE(settings.Word("three", kWords)
                .error()
                .message.find("setting three is '1 2.5 -3', expected a or b"),
            std::string::npos);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace lf
