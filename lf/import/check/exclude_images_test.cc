// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/exclude_images.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

using Names = std::vector<std::string>;

LightField FieldOf(const Names& names) {
  LightField light_field;
  light_field.intrinsics = {{100, 100, 50, 40, 0, 100, 80}};
  for (const std::string& name : names) {
    LfCamera camera;
    camera.gain = static_cast<float>(light_field.size() + 1);
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(name);
    light_field.mask_names.push_back("mask_of_" + name);
  }
  return light_field;
}

const Names kNames = {"left/01.png", "left/02.png", "right/01.png", "right/[x].png"};

// Returns those of kNames that remain when `patterns` are excluded.
Names Left(const Names& patterns) {
  LightField light_field = FieldOf(kNames);
  const Result<size_t> removed = ExcludeImages(patterns, &light_field);
  EXPECT_TRUE(removed) << removed.error().message;
  EXPECT_EQ(*removed, kNames.size() - light_field.size());
  EXPECT_EQ(light_field.cameras.size(), light_field.image_names.size());
  for (size_t i = 0; i < light_field.size(); ++i) {
    EXPECT_EQ(light_field.mask_names[i], "mask_of_" + light_field.image_names[i]);
    const auto index = static_cast<size_t>(light_field.cameras[i].gain[0]) - 1;
    EXPECT_EQ(light_field.image_names[i], kNames[index]);
  }
  return light_field.image_names;
}

std::string ErrorOf(const Names& patterns) {
  LightField light_field = FieldOf(kNames);
  const Result<size_t> removed = ExcludeImages(patterns, &light_field);
  EXPECT_EQ(light_field.image_names, kNames);
  return removed ? "" : removed.error().message;
}

TEST(ExcludeImages, TakesNamesWithAndWithoutTheirFolder) {
  EXPECT_EQ(Left({}), kNames);
  EXPECT_EQ(Left({"left/01.png"}), (Names{"left/02.png", "right/01.png", "right/[x].png"}));
  EXPECT_EQ(Left({"01.png"}), (Names{"left/02.png", "right/[x].png"}));
  EXPECT_EQ(Left({"[x].png"}), (Names{"left/01.png", "left/02.png", "right/01.png"}));
}

TEST(ExcludeImages, TakesWildcards) {
  EXPECT_EQ(Left({"left*"}), (Names{"right/01.png", "right/[x].png"}));
  EXPECT_EQ(Left({"0[12].png"}), (Names{"right/[x].png"}));
  EXPECT_EQ(Left({"?2.png", "right/0?.png"}), (Names{"left/01.png", "right/[x].png"}));
  EXPECT_EQ(Left({"02.png", "0[2].png", "02.png"}).size(), 3u);
}

TEST(ExcludeImages, APatternThatNamesNothingIsAnError) {
  EXPECT_NE(ErrorOf({"01.png", "03.png"}).find("\"03.png\" matches none of the 4 image names"),
            std::string::npos);
  EXPECT_NE(ErrorOf({"left"}).find("\"left\""), std::string::npos);
  EXPECT_NE(ErrorOf({"*"}).find("match all 4 images"), std::string::npos);
}

TEST(ExcludeImages, FaultyImagesAreLeftOut) {
  LightField light_field = FieldOf(kNames);
  ImageFaults faults;
  faults.broken = {{LfImageId{0}, "left/01.png: is cut off"}};
  faults.missing = {{LfImageId{2}, "right/01.png: no such file"}};
  EXPECT_EQ(*ExcludeFaulty(faults, &light_field), 2u);
  EXPECT_EQ(light_field.image_names, (Names{"left/02.png", "right/[x].png"}));
  EXPECT_EQ(*ExcludeFaulty({}, &light_field), 0u);
  faults.broken.push_back({LfImageId{1}, "right/[x].png: is cut off"});
  faults.missing.clear();
  const Result<size_t> all = ExcludeFaulty(faults, &light_field);
  ASSERT_FALSE(all);
  EXPECT_NE(all.error().message.find("all 2 images are missing or broken; the first: left/01.png"),
            std::string::npos);
}

class PatternFileTest : public FolderTest {};

TEST_F(PatternFileTest, PatternsComeFromListsAndFiles) {
  const std::string path = (folder_ / "bad.txt").string();
  ASSERT_TRUE(WriteFileAtomically(path, "a, b.png\r\n\nc.png"));
  EXPECT_EQ(*ReadPatterns(Names{"x.png,,y*", "@" + path, "z"}),
            (Names{"x.png", "y*", "a, b.png", "c.png", "z"}));
  EXPECT_FALSE(ReadPatterns(Names{"@" + path + "x"}));
}

}  // namespace
}  // namespace lf
