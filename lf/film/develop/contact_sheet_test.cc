// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/contact_sheet.h"

#include <gtest/gtest.h>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class ContactSheetTest : public FolderTest {
 protected:
  Image<uint8_t> Sheet(const std::vector<Image<uint8_t>>& pictures, int max_width_px) const {
    ContactSheet sheet(pictures.size(), pictures[0].width(), pictures[0].height(), max_width_px);
    for (size_t i = 0; i < pictures.size(); ++i) sheet.Place(i, pictures[i]);
    EXPECT_TRUE(sheet.Write(folder_ / "sheet.png"));
    return std::get<Image<uint8_t>>(ReadImage(folder_ / "sheet.png").value());
  }
};

TEST(ContactSheetFrames, AreSpreadEvenlyWithFirstAndLast) {
  EXPECT_EQ(ContactSheetFrames(3), (std::vector<size_t>{0, 1, 2}));
  EXPECT_EQ(ContactSheetFrames(900, 4), (std::vector<size_t>{0, 300, 599, 899}));
  EXPECT_EQ(ContactSheetFrames(5, 1), (std::vector<size_t>{0}));
  EXPECT_TRUE(ContactSheetFrames(0).empty());
  EXPECT_TRUE(ContactSheetFrames(5, 0).empty());
  for (size_t count = 1; count < 60; ++count) {
    const auto frames = ContactSheetFrames(count);
    ASSERT_EQ(frames.size(), std::min<size_t>(count, 12));
    EXPECT_EQ(frames.front(), 0u);
    EXPECT_EQ(frames.back(), count - 1);
    for (size_t i = 1; i < frames.size(); ++i) {
      const double step = static_cast<double>(count - 1) / static_cast<double>(frames.size() - 1);
      EXPECT_GT(frames[i], frames[i - 1]);
      EXPECT_NEAR(static_cast<double>(frames[i]), static_cast<double>(i) * step, 0.51);
    }
  }
}

TEST_F(ContactSheetTest, SmallPicturesStandSideBySideUnchanged) {
  std::vector<Image<uint8_t>> pictures;
  for (int i = 0; i < 3; ++i) pictures.emplace_back(20, 10, 3, static_cast<uint8_t>(80 + 50 * i));
  const auto sheet = Sheet(pictures, 1920);
  EXPECT_EQ(sheet.width(), 2 * 20 + 3 * 4);  // a grid of 2 x 2 cells with borders, one cell empty
  EXPECT_EQ(sheet.height(), 2 * 10 + 3 * 4);
  EXPECT_EQ(sheet.at(4, 4), 80);
  EXPECT_EQ(sheet.at(23, 13), 80);
  EXPECT_EQ(sheet.at(28, 4), 130);
  EXPECT_EQ(sheet.at(4, 18), 180);
  EXPECT_EQ(sheet.at(24, 4), sheet.at(0, 0));
  EXPECT_EQ(sheet.at(28, 18), sheet.at(0, 0));
}

TEST_F(ContactSheetTest, LightIsAveragedNotItsCode) {
  Image<uint8_t> checkerboard(64, 64, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) checkerboard.at(x, y, c) = (x + y) % 2 == 0 ? 255 : 0;
  const auto sheet = Sheet({checkerboard}, 32 + 8);
  EXPECT_EQ(sheet.width(), 40);
  for (int y = 4; y < 36; ++y)
    for (int x = 4; x < 36; ++x) ASSERT_EQ(sheet.at(x, y, 1), 188);  // sRGB value of linear 0.5
}

TEST_F(ContactSheetTest, APageIsNeverWiderThanAskedForAndKeepsUniformColours) {
  for (const int count : {1, 2, 5, 12})
    for (const int width : {60, 101, 333}) {
      const std::vector<Image<uint8_t>> pictures(count, Image<uint8_t>(97, 55, 3, 77));
      const auto sheet = Sheet(pictures, width);
      EXPECT_LE(sheet.width(), width);
      EXPECT_EQ(sheet.at(5, 5, 0), 77);
    }
}

TEST_F(ContactSheetTest, NowhereToWriteIsAnError) {
  const ContactSheet sheet(1, 4, 4);
  EXPECT_EQ(sheet.Write(folder_ / "none" / "a.png").error().kind, ErrorKind::kOutput);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace lf
