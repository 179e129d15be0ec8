// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/file_inputs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/pixels/files/exr_parts.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

const FileInputs kInputs = {{"layout", "quilt 3x3"}, {"frames", "0123"}, {"empty", ""}};

class FileInputsTest : public FolderTest {
 protected:
  ThreadPool pool_{2};
};

TEST_F(FileInputsTest, PicturesStateWhatTheyAreMadeOf) {
  for (const char* const name : {"a.png", "a.exr"}) {
    const bool is_exr = std::string(name) == "a.exr";
    const StoredImage picture =
        is_exr ? StoredImage(Image<float>(4, 3, 3)) : StoredImage(Image<uint8_t>(4, 3, 3));
    const ColourFacts facts = {is_exr ? PixelType::kHalf : PixelType::kUint8};
    ASSERT_TRUE(WriteStoredImage(folder_ / name, picture, {"R", "G", "B"}, facts));
    EXPECT_EQ(ReadInputs(folder_ / name), std::nullopt);
    ASSERT_TRUE(WriteStoredImage(folder_ / name, picture, {"R", "G", "B"}, facts,
                                 {{kInputsText, TextOfInputs(kInputs)}}));
    EXPECT_EQ(ReadInputs(folder_ / name), kInputs) << name;
  }
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a.png", "no picture"));
  EXPECT_EQ(ReadInputs(folder_ / "a.png"), std::nullopt);
}

TEST_F(FileInputsTest, AFileOfSeveralPicturesStatesWhatItIsMadeOf) {
  std::vector<ExrPart> planes;
  for (const std::string name : {"near", "far"}) {
    planes.push_back({folder_ / (name + ".exr"), name});
    ASSERT_TRUE(WriteStoredImage(planes.back().from, Image<float>(4, 3, 3), {"R", "G", "B"},
                                 {PixelType::kHalf}));
  }
  const auto stack = folder_ / "stack.exr";
  ASSERT_TRUE(JoinExr(stack, planes));
  EXPECT_EQ(ReadInputs(stack), std::nullopt);
  ASSERT_TRUE(JoinExr(stack, planes, {}, {{kInputsText, TextOfInputs(kInputs)}}));
  EXPECT_EQ(ReadInputs(stack), kInputs);
}

TEST_F(FileInputsTest, VideosStateWhatTheyAreMadeOf) {
  const auto video = folder_ / "a.mp4";
  const std::string box(
      "\0\0\0\x0c"
      "ftypisom",
      12);
  ASSERT_TRUE(WriteFileAtomically(video, box));
  EXPECT_EQ(ReadInputs(video), std::nullopt);
  ASSERT_TRUE(AppendInputs(video, TextOfInputs(kInputs)));
  EXPECT_EQ(ReadInputs(video), kInputs);
  const std::string whole = ReadFile(video).value();
  ASSERT_TRUE(WriteFileAtomically(video, whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(ReadInputs(video), std::nullopt) << "the box is cut";
}

TEST_F(FileInputsTest, TheHashIsOfContentsInTheirOrder) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "a", "one"));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "b", "two"));
  const auto hash = [&](const std::vector<std::filesystem::path>& files) {
    const auto made = HashOfFiles(files, pool_);
    EXPECT_TRUE(made) << made.error().message;
    return made ? *made : "";
  };
  const std::string before = hash({folder_ / "a", folder_ / "b"});
  EXPECT_NE(before, hash({folder_ / "b", folder_ / "a"}));
  std::filesystem::rename(folder_ / "a", folder_ / "c");
  EXPECT_EQ(before, hash({folder_ / "c", folder_ / "b"}));
  ASSERT_TRUE(WriteFileAtomically(folder_ / "c", "six"));
  EXPECT_NE(before, hash({folder_ / "c", folder_ / "b"}));
  EXPECT_FALSE(HashOfFiles(std::vector{folder_ / "missing"}, pool_));
}

}  // namespace
}  // namespace lf
