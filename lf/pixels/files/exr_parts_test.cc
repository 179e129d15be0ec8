// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/exr_parts.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

class ExrPartsTest : public FolderTest {
 protected:
  // Writes a picture whose first value is `first`, and returns it as a part.
  ExrPart Part(const std::string& name, float first, int width = 5, int height = 40) const {
    Image<float> image(width, height, 1);
    for (size_t i = 0; i < image.pixels().size(); ++i)
      image.pixels()[i] = first + static_cast<float>(i);
    const std::filesystem::path path = folder_ / (name + ".exr");
    const std::vector<ExrChannel> channels = {{"G", image.view(), 0, false}};
    EXPECT_TRUE(WriteExr(path, channels, {{"lf:focus_distance_w", double{first}}}));
    return {path, name};
  }
  std::filesystem::path joined() const { return folder_ / "joined.exr"; }
};

TEST_F(ExrPartsTest, KeepPixelsAndAttributes) {
  ASSERT_TRUE(JoinExr(joined(), std::vector{Part("b", 1), Part("a", 2), Part("c", 3)}));
  Imf::MultiPartInputFile file(joined().c_str(), 0);
  ASSERT_EQ(file.parts(), 3);
  for (int i = 0; i < 3; ++i) {
    const Imf::Header& header = file.header(i);
    EXPECT_EQ(header.name(), std::string(1, "bac"[i]));
    EXPECT_EQ(header.typedAttribute<Imf::DoubleAttribute>("lf:focus_distance_w").value(), i + 1);
    Image<float> image(5, 40, 1);
    Imf::FrameBuffer buffer;
    buffer.insert("G", Imf::Slice::Make(Imf::FLOAT, image.pixels().data(), header.dataWindow()));
    Imf::InputPart part(file, i);
    part.setFrameBuffer(buffer);
    part.readPixels(0, 39);
    for (size_t k = 0; k < 200; ++k)
      ASSERT_EQ(image.pixels()[k], static_cast<float>(i + 1) + static_cast<float>(k));
  }
}

TEST_F(ExrPartsTest, SeveralPicturesAreNoPicture) {
  std::vector<ExrPart> parts;
  for (const std::string name : {"near", "far"}) {
    const Image<float> image(2, 2, 1);
    const auto path = folder_ / (name + ".exr");
    const std::vector<ExrChannel> channels = {{"R", image.view(), 0, false},
                                              {"G", image.view(), 0, false},
                                              {"B", image.view(), 0, false}};
    ASSERT_TRUE(WriteExr(path, channels));
    EXPECT_TRUE(ReadPictureHeader(path));
    parts.push_back({path, name});
  }
  ASSERT_TRUE(JoinExr(joined(), parts, {}, {{"story", "of two"}}));
  const auto expect_refused = [](const auto& read) {
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    EXPECT_NE(read.error().message.find("joined.exr: holds 2 pictures"), std::string::npos);
  };
  expect_refused(ReadPictureHeader(joined()));
  expect_refused(ReadImageInfo(joined()));
  expect_refused(ReadImage(joined()));
  EXPECT_EQ(ReadStatedText(joined(), "story").value(), "of two");
  EXPECT_EQ(ReadStatedText(joined(), "name of none").value(), "");
}

TEST_F(ExrPartsTest, MustHaveOneSize) {
  const auto result = JoinExr(joined(), std::vector{Part("a", 1), Part("b", 2, 6)});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kInput);
  EXPECT_NE(result.error().message.find("b.exr: has another size"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(joined()));
}

TEST_F(ExrPartsTest, MustBeFiles) {
  const auto result =
      JoinExr(joined(), std::vector{Part("a", 1), ExrPart{folder_ / "no.exr", "b"}});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kInput);
  EXPECT_NE(result.error().message.find("no.exr: cannot be read"), std::string::npos);
}

TEST_F(ExrPartsTest, AreNotWrittenIntoAMissingFolder) {
  const auto result = JoinExr(folder_ / "no" / "joined.exr", std::vector{Part("a", 1)});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kOutput);
}

TEST_F(ExrPartsTest, AreNotWrittenAfterAnInterruption) {
  int calls = 0;
  const auto result =
      JoinExr(joined(), std::vector{Part("a", 1), Part("b", 2)}, [&calls] { return ++calls == 2; });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kInterrupted);
  EXPECT_FALSE(std::filesystem::exists(joined()));
}

}  // namespace
}  // namespace lf
