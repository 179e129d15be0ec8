// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/light_field_words.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace lf {
namespace {

using Words = std::vector<std::string>;

TEST(LightFieldWords, WhatIsNotSaidGivesNoWord) {
  EXPECT_EQ(LightFieldWords().Words(), Words{});
  LightFieldWords words;
  words.image_scale = "0.25";
  words.fov_deg = 60;
  EXPECT_EQ(words.Words(), (Words{"--fov-deg", "60", "--image-scale", "0.25"}));
}

TEST(LightFieldWords, AreReadAgainInAnotherFolder) {
  LightFieldWords words;
  words.focal_px = 768.125;
  words.fov_deg = 50;
  words.images = "moved";
  words.image_scale = "off";
  words.image_alpha = "straight";
  words.background = "0.2,0.2,0.3";
  words.time = -0.1;
  words.recorded_fps = 29.97;
  words.frame_cache = "decoded";
  words.store_cache = "copied";
  const Words kept = words.WordsToKeep();
  const auto read = LightFieldWords::Of("field", kept);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->focal_px, words.focal_px);
  EXPECT_EQ(read->fov_deg, words.fov_deg);
  EXPECT_EQ(read->images, (std::filesystem::current_path() / "moved").string());
  EXPECT_EQ(read->image_scale, words.image_scale);
  EXPECT_EQ(read->image_alpha, words.image_alpha);
  EXPECT_EQ(read->background, words.background);
  EXPECT_EQ(read->time, words.time);
  EXPECT_EQ(read->recorded_fps, words.recorded_fps);
  EXPECT_EQ(read->frame_cache, (std::filesystem::current_path() / "decoded").string());
  EXPECT_EQ(read->store_cache, (std::filesystem::current_path() / "copied").string());
  EXPECT_EQ(read->Words(), kept);
}

TEST(LightFieldWords, OthersAreRefusedAndNamed) {
  for (const Words& wrong :
       {Words{"--speed", "3"}, Words{"--fov-deg"}, Words{"--fov-deg", "180"},
        Words{"--focal-px", "-1"}, Words{"--focal-px", "nan"}, Words{"--image-alpha", "yes"},
        Words{"--background", ""}, Words{"--time", "now"}, Words{"images", "here"}}) {
    const auto read = LightFieldWords::Of("field", wrong);
    ASSERT_FALSE(read) << wrong[0];
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    EXPECT_NE(
        read.error().message.find("options of field cannot be read again: found '" + wrong[0]),
        std::string::npos)
        << read.error().message;
  }
}

TEST(LightFieldWords, BecomeOptions) {
  LightFieldWords words;
  words.background = "0.5,0,1";
  words.image_alpha = "premultiplied";
  words.image_scale = "0.5";
  const auto options = words.Options();
  ASSERT_TRUE(options);
  EXPECT_EQ(options->background, (std::array<double, 3>{0.5, 0, 1}));
  EXPECT_FALSE(options->keeps_opacity);
  EXPECT_EQ(options->alpha, AlphaMeaning::kPremultiplied);
  EXPECT_EQ(options->image_scale.factor, 0.5);
  EXPECT_FALSE(options->focal_px);
  words.background = kNoBackground;
  EXPECT_TRUE(words.Options()->keeps_opacity);
  for (const char* wrong : {"blue", "1,2", "1,2,3,4", "1,2,-3", "1,2,nan", "1,2,1e7", "1,2,3 "}) {
    words.background = wrong;
    const auto refused = words.Options();
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace lf
