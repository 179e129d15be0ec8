// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/image_files.h"

#include <gtest/gtest.h>

#include "lf/core/file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class ImageFilesTest : public FolderTest {};

TEST_F(ImageFilesTest, AreSortedByBytesWithoutOtherFiles) {
  for (const char* name : {"b.JPG", "a10.png", "a2.png", "B.exr", ".c.png", "d.txt", "notes"})
    ASSERT_TRUE(WriteFileAtomically(folder_ / name, "x"));
  std::filesystem::create_directories(folder_ / "folder.png");
  EXPECT_EQ(*SortedImageNames(folder_),
            (std::vector<std::string>{"B.exr", "a10.png", "a2.png", "b.JPG"}));
  const auto error = SortedImageNames(folder_ / "none");
  ASSERT_FALSE(error);
  EXPECT_NE(error.error().message.find("none: cannot be listed"), std::string::npos);
}

TEST_F(ImageFilesTest, TellTheirSizeInTheHeader) {
  const Image<uint8_t> image(7, 5, 3);
  ASSERT_TRUE(WriteImage(folder_ / "a.png", image.view()));
  EXPECT_EQ(*ImageSizeInHeader(folder_ / "a.png"), (std::array{7, 5}));
  EXPECT_FALSE(ImageSizeInHeader(folder_ / "none.png"));
}

}  // namespace
}  // namespace lf
