// SPDX-License-Identifier: Apache-2.0
#include "lf/core/files_nearby.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace lf {
namespace {
namespace fs = std::filesystem;

class FilesNearbyTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  void Touch(const fs::path& name) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name).put('x');
  }
  std::string Of(const fs::path& name) { return FilesNearby(folder_ / name); }

  const fs::path folder_ =
      fs::temp_directory_path() / ("lf_files_nearby_test." + std::to_string(::getpid()));
};

TEST_F(FilesNearbyTest, ASimilarNameIsNamed) {
  Touch("image_7.png");
  Touch("image_8.png");
  Touch("image_10.png");
  EXPECT_EQ(Of("image_07.png"), "; similar there: image_7.png");
  EXPECT_EQ(Of("IMAGE_0010.JPG"), "; similar there: image_10.png");
  EXPECT_EQ(Of("image 8.png"), "; similar there: image_8.png");
  Touch("view_3 (1).png");
  Touch("view_3 - Copy.png");
  EXPECT_EQ(Of("view_3.png"), "; similar there: view_3 (1).png, view_3 - Copy.png");
}

TEST_F(FilesNearbyTest, ElseTheFolderIsDescribed) {
  EXPECT_EQ(Of("a.png"), "; its folder is empty");
  fs::create_directory(folder_ / "deep");
  EXPECT_EQ(Of("a.png"), "; its folder holds no files, but deep/");
  Touch("b.png");
  Touch("c.png");
  EXPECT_EQ(Of("a.png"), "; its folder holds 2 files, such as b.png");
  for (int i = 0; i < 5000; ++i) Touch("many/" + std::to_string(i));
  EXPECT_EQ(Of("many/x").find("; its folder holds at least 4096 files, such as "), 0u);
}

TEST_F(FilesNearbyTest, AMissingFolderIsNamed) {
  const std::string gone = "; there is no folder " + (folder_ / "images").string();
  EXPECT_EQ(Of("images/a.png"), gone);
  Touch("photos/a.png");
  fs::create_directory(folder_ / "masks");
  EXPECT_EQ(Of("images/left/a.png"), gone + ": " + folder_.string() + " holds masks/, photos/");
}

TEST_F(FilesNearbyTest, ALinkToNowhereIsToldOf) {
  fs::create_symlink("/nowhere/images", folder_ / "images");
  EXPECT_EQ(Of("images/a.png"), "; " + (folder_ / "images").string() +
                                    " is a link to /nowhere/images, which is not there");
  fs::create_symlink("/nowhere/a.png", folder_ / "a.png");
  EXPECT_EQ(Of("a.png"), "; it is a link to /nowhere/a.png, which is not there");
}

}  // namespace
}  // namespace lf
