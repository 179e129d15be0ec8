// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/synthetic_field.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class SyntheticFieldTest : public ::testing::Test {
 protected:
  SyntheticFieldTest()
      : folder_(fs::temp_directory_path() /
                ("lf_synthetic_field_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    options_.scene = "chart";
    options_.output = folder_;
    options_.size_px = {16, 12};
    options_.count = 4;
    options_.samples = 1;
  }
  ~SyntheticFieldTest() override { fs::remove_all(folder_); }

  Result<void> Write() {
    return WriteSyntheticField(options_, pool_, [](size_t, size_t, bool) { return true; });
  }
  // Expects that the options are refused, with a message that has these words.
  void ExpectRefused(const std::string& words) {
    const Result<void> written = Write();
    ASSERT_FALSE(written) << words;
    EXPECT_EQ(written.error().kind, ErrorKind::kUsage);
    EXPECT_NE(written.error().message.find(words), std::string::npos) << written.error().message;
  }

  fs::path folder_;
  SyntheticFieldOptions options_;
  ThreadPool pool_{1};
};

TEST_F(SyntheticFieldTest, WritesWhatIsAskedFor) {
  options_.capture = "hemisphere";
  options_.fov = 0.5;
  options_.format = "png";
  ASSERT_TRUE(Write());
  const Result<LightField> field = ReadTransformsJson(folder_ / "transforms.json");
  ASSERT_TRUE(field);
  EXPECT_EQ(field->size(), 4u);
  EXPECT_EQ(field->Camera({0}).intrinsics.width_px, 16);
  EXPECT_EQ(field->Camera({0}).intrinsics.distortion.model, DistortionModel::kFov);
  EXPECT_TRUE(fs::exists(folder_ / "images/0003.png"));
  EXPECT_FALSE(fs::exists(folder_ / "truth"));
}

TEST_F(SyntheticFieldTest, ReplacesOnlyItsOwnImages) {
  ASSERT_TRUE(Write());
  ExpectRefused("exists already");
  options_.overwrite = true;
  options_.count = 1;
  std::ofstream(folder_ / "images/mine.exr") << "kept";
  ASSERT_TRUE(Write());
  EXPECT_TRUE(fs::exists(folder_ / "images/0000.exr"));
  EXPECT_FALSE(fs::exists(folder_ / "images/0003.exr"));
  EXPECT_TRUE(fs::exists(folder_ / "images/mine.exr"));
}

TEST_F(SyntheticFieldTest, HidesNoOtherLightField) {
  options_.holds_light_field = [&](const fs::path& folder) { return folder == folder_; };
  ExpectRefused("holds a light field that lfsynth did not write");
  options_.holds_light_field = [](const fs::path&) { return false; };
  EXPECT_TRUE(Write());
}

TEST_F(SyntheticFieldTest, KeepsTheFilesThatItWasMadeOf) {
  fs::create_directories(folder_ / "truth");
  options_.inputs = {folder_ / "images/0002.exr"};
  fs::create_directories(folder_ / "images");
  std::ofstream(options_.inputs[0]) << "a path";
  ExpectRefused("0002.exr");
  EXPECT_EQ(fs::file_size(options_.inputs[0]), 6u);
}

TEST_F(SyntheticFieldTest, RefusesContradictions) {
  options_.scene = "moon";
  ExpectRefused("scene moon: expected one of still-life");
  options_.scene = "chart";
  options_.noise = 0.1;
  ExpectRefused("can only be used with mosaics");
  options_.bayer = true;
  options_.format = "png";
  ExpectRefused("mosaics are always 16-bit PNG");
  options_.format = "exr";
  options_.alpha = "straight";
  ExpectRefused("mosaics have no alpha");
  options_.bayer = false;
  options_.noise = 0;
  options_.scene = "lights";
  ExpectRefused("which has no surfaces");
  options_.alpha = "none";
  options_.capture = "hemisphere";
  options_.spacing = 1;
  ExpectRefused("determine it");
  EXPECT_FALSE(fs::exists(folder_ / "transforms.json"));
}

TEST_F(SyntheticFieldTest, EndsWhenItIsAsked) {
  const auto written =
      WriteSyntheticField(options_, pool_, [](size_t done, size_t, bool) { return done < 2; });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kInterrupted);
  EXPECT_FALSE(fs::exists(folder_ / "transforms.json"));
}

}  // namespace
}  // namespace lf
