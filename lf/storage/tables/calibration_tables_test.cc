// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/tables/calibration_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lf {
namespace {

constexpr DatabaseFormat kFormat = {"test file", 0x4C465454, 1};

class CalibrationTablesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    database_ = Database::Create(path_, kFormat).value();
    ASSERT_TRUE(database_->Execute(kSettingsTable));
    ASSERT_TRUE(database_->Execute(kIntrinsicsTable));
  }
  void TearDown() override {
    database_.reset();
    std::filesystem::remove(path_);
  }
  Result<std::vector<Intrinsics>> Read() {
    return ReadIntrinsics(Settings::Read(*database_, "test file").value(), &*database_);
  }
  // Inserts a row of intrinsics as a file may contain it.
  void Insert(const std::string& distortion, const std::string& parameters, double fx_px = 500) {
    ASSERT_TRUE(database_->Execute(
        fmt::format("insert into intrinsics values (0, 640, 480, {}, 501, 320, 240, 0, '{}', '{}')",
                    fx_px, distortion, parameters)));
  }

  const std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                      ("lf_calibration_test." + std::to_string(::getpid()));
  std::optional<Database> database_;
};

TEST_F(CalibrationTablesTest, EveryLensIsReadAsItWasWritten) {
  using enum DistortionModel;
  std::vector<Intrinsics> written;
  for (const Distortion& lens :
       {Distortion{}, Distortion{kRadialTangential, {0.1, 1.0 / 3, 1e-3, 2e-3, 5, 6, 7, 8}},
        Distortion{kFisheye, {0.1}}, Distortion{kFov, {0.9}}, Distortion{kDivision, {-0.1}},
        Distortion{kUnified, {0.5, 2}}, Distortion{kThinPrism, {1, 2, 3, 4, 5, 6, 7, 2.0 / 3}},
        Distortion{kBrown, {1, 2, 3, 4, 5, 2.0 / 3}},
        Distortion{kRadialTangentialThinPrism, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 2.0 / 3}}})
    written.push_back({500, 501, 320, 240, 0.5, 640, 480, lens});
  ASSERT_TRUE(WriteIntrinsics(written, &*database_));
  EXPECT_EQ(Read().value(), written);
}

// A larger pedestal is refused: 65535 would leave no range for light.
TEST_F(CalibrationTablesTest, APedestalLeavesHalfOfTheRangeToLight) {
  LightField light_field;
  light_field.encoding.pedestal = kMostPedestal;
  ASSERT_TRUE(WriteSettings(SettingsOfPixels(light_field), &*database_));
  const auto read = [&] {
    return ReadPixelSettings(Settings::Read(*database_, "test file").value(), &light_field);
  };
  EXPECT_TRUE(read()) << read().error().message;
  for (const char* const wrong : {"32768", "65535", "-1", "1e300"}) {
    ASSERT_TRUE(database_->Execute(
        fmt::format("update settings set value = '{}' where key = 'pedestal'", wrong)));
    const Result<void> refused = read();
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().kind, ErrorKind::kInput);
    EXPECT_NE(refused.error().message.find(fmt::format(
                  "setting pedestal is '{}', expected a number from 0 to 32767", wrong)),
              std::string::npos)
        << refused.error().message;
  }
}

TEST_F(CalibrationTablesTest, KeepsWhatPixelsShow) {
  LightField light_field;
  light_field.encoding.footprint = PixelFootprint::kPoint;
  ASSERT_TRUE(WriteSettings(SettingsOfPixels(light_field), &*database_));
  const auto footprint = [&]() -> Result<std::optional<PixelFootprint>> {
    LightField read;
    LF_RETURN_IF_ERROR(ReadPixelSettings(Settings::Read(*database_, "test file").value(), &read));
    return read.encoding.footprint;
  };
  EXPECT_EQ(footprint().value(), PixelFootprint::kPoint);
  ASSERT_TRUE(database_->Execute("update settings set value = 'dots' where key = 'footprint'"));
  EXPECT_FALSE(footprint());
  // Older files do not have it.
  ASSERT_TRUE(database_->Execute("delete from settings where key = 'footprint'"));
  EXPECT_EQ(footprint().value(), std::nullopt);
}

TEST_F(CalibrationTablesTest, ALensOfAnOlderFileHasEightParameters) {
  Insert("thin_prism", "1 2 3 4 5 6 7 8");
  const Distortion expected = {DistortionModel::kThinPrism, {1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(Read().value()[0].distortion, expected);
}

// An older program can read the rows of a newer one for the models that it knows.
TEST_F(CalibrationTablesTest, ALensOfAnOlderModelIsWrittenWithEightParameters) {
  const Distortion fisheye = {DistortionModel::kFisheye, {1, 2, 3, 4}};
  ASSERT_TRUE(WriteIntrinsics({{500, 501, 320, 240, 0, 640, 480, fisheye}}, &*database_));
  std::string text;
  ASSERT_TRUE(ForEachRow(*database_, "select parameters from intrinsics",
                         [&text](const Statement& row) -> Result<void> {
                           text = row.Text(0).value();
                           return {};
                         }));
  EXPECT_EQ(text, "1 2 3 4 0 0 0 0");
}

TEST_F(CalibrationTablesTest, IntrinsicsOutOfRangeAreNamed) {
  Insert("fisheye", "1 2 3 4 0 0 0 0", 0);
  const std::string message = Read().error().message;
  EXPECT_NE(message.find("intrinsics are out of range: 640 x 480 pixels, focal lengths 0 and "
                         "501, principal point 320 240, skew 0, lens distortion 'fisheye 1 2 3 4 "
                         "0 0 0 0'"),
            std::string::npos)
      << message;
}

TEST_F(CalibrationTablesTest, AGainIsNamedAsItWasFound) {
  const Settings settings = Settings::Read(*database_, "test file").value();
  for (const auto& [value, text] : {std::pair("'bright'", "bright"), std::pair("'1 2'", "1 2"),
                                    std::pair("'1 2 -3'", "1 2 -3"), std::pair("-0.5", "-0.5")}) {
    Statement row = database_->Prepare(fmt::format("select 0, {}, x'00'", value)).value();
    ASSERT_TRUE(row.Step().value());
    const Result<LfCamera> camera = ReadCamera(settings, row, 0, "a.png", 1);
    ASSERT_FALSE(camera);
    EXPECT_NE(camera.error().message.find(
                  fmt::format("LF image 'a.png' has the gain '{}', expected", text)),
              std::string::npos)
        << camera.error().message;
  }
}

TEST_F(CalibrationTablesTest, AWrongNumberOfParametersIsDamage) {
  Insert("radial_tangential_thin_prism", "1 2 3 4 5 6 7 8");
  const std::string message = Read().error().message;
  EXPECT_NE(message.find("radial_tangential_thin_prism 1 2 3 4 5 6 7 8', expected 12 or 15"),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace lf
