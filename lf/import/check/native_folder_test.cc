// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/native_folder.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class NativeFolderTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    for (const char* name : {"field/images", "out/deep"}) fs::create_directories(folder_ / name);
    ASSERT_TRUE(WriteFileAtomically(folder_ / "field/images/a.png", "a"));
    ASSERT_TRUE(WriteFileAtomically(folder_ / "field/mask.png", "m"));
    field_.folder = folder_ / "field";
    field_.cameras.resize(2);
    field_.image_names = {"images/a.png", (folder_ / "field/images/a.png").string()};
    field_.mask_names = {"mask.png", ""};
  }
  void ExpectAllFound() const {
    for (uint32_t i = 0; i < 2; ++i)
      EXPECT_EQ(*ReadFile(field_.ImagePath({i})), "a") << field_.image_names[i];
    EXPECT_EQ(*ReadFile(field_.folder / field_.mask_names[0]), "m");
    EXPECT_EQ(field_.mask_names[1], "");
  }
  LightField field_;
};

TEST_F(NativeFolderTest, LeadToTheSameFilesFromAnywhere) {
  ASSERT_TRUE(MoveToFolder(folder_ / "out/deep", &field_));
  EXPECT_EQ(field_.image_names[0], "../../field/images/a.png");
  EXPECT_EQ(field_.image_names[1], "../../field/images/a.png");
  EXPECT_EQ(field_.mask_names[0], "../../field/mask.png");
  ExpectAllFound();
}

TEST_F(NativeFolderTest, StayAsTheyAreInTheirOwnFolder) {
  ASSERT_TRUE(MoveToFolder(folder_ / "out" / ".." / "field", &field_));
  EXPECT_EQ(field_.image_names[0], "images/a.png");
  EXPECT_EQ(field_.image_names[1], "images/a.png");
  ExpectAllFound();
}

TEST_F(NativeFolderTest, FollowLinks) {
  fs::create_directory_symlink(folder_ / "out/deep", folder_ / "link");
  fs::create_directory_symlink(folder_ / "field/images", folder_ / "images");
  field_.image_names[1] = (folder_ / "images" / "a.png").string();
  ASSERT_TRUE(MoveToFolder(folder_ / "link", &field_));
  EXPECT_EQ(field_.image_names[0], "../../field/images/a.png");
  EXPECT_EQ(field_.image_names[1], "../../images/a.png");
  ExpectAllFound();
}

TEST_F(NativeFolderTest, FarAwayFilesKeepTheirAbsoluteNames) {
  field_.image_names[1] = "/nowhere/a.png";
  ASSERT_TRUE(MoveToFolder(folder_ / "out", &field_));
  EXPECT_EQ(field_.image_names[1], "/nowhere/a.png");
  EXPECT_FALSE(MoveToFolder(folder_ / "none", &field_));
}

TEST_F(NativeFolderTest, IsWrittenAndReadBack) {
  field_.intrinsics = {{50, 50, 18, 10, 0, 36, 20}};
  const Result<std::string> path = WriteNativeFolder(folder_ / "new/native", &field_);
  ASSERT_TRUE(path) << path.error().message;
  const Result<LightField> read = ReadTransformsJson(*path);
  ASSERT_TRUE(read) << read.error().message;
  field_ = *read;
  ExpectAllFound();
}

TEST_F(NativeFolderTest, WhatOthersWroteIsNotReplacedUnforced) {
  field_.intrinsics = {{50, 50, 18, 10, 0, 36, 20}};
  const fs::path out = folder_ / "out", elsewhere = folder_ / "field";
  EXPECT_TRUE(CheckMayWrite(elsewhere, out, false));
  ASSERT_TRUE(WriteNativeFolder(out, &field_));
  EXPECT_TRUE(CheckMayWrite(elsewhere, out, false));

  // Even a file that we wrote is not replaced if it is the one that the light field was read from.
  for (const fs::path& source : {out, out / "transforms.json", out / "deep" / ".."}) {
    const Result<void> may = CheckMayWrite(source, out, false);
    ASSERT_FALSE(may);
    EXPECT_EQ(may.error().kind, ErrorKind::kUsage);
    EXPECT_NE(may.error().message.find("is the calibration that is read"), std::string::npos);
    EXPECT_TRUE(CheckMayWrite(source, out, true));
  }
  ASSERT_TRUE(WriteFileAtomically(out / "transforms.json", "{}"));
  const Result<void> may = CheckMayWrite(elsewhere, out, false);
  ASSERT_FALSE(may);
  EXPECT_NE(may.error().message.find("not written by lfimport"), std::string::npos);
  EXPECT_TRUE(CheckMayWrite(elsewhere, out, true));
}

}  // namespace
}  // namespace lf
