// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/alpha_evidence.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <limits>
#include <optional>

#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

constexpr int kSide = 20;

// A light field of three LF images; each test writes as many image files as it needs.
class AlphaEvidenceTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    field_.cameras.resize(3);
    field_.intrinsics = {{10, 10, 10, 10, 0, kSide, kSide}};
    field_.image_names = {"0.png", "1.png", "2.png"};
    field_.folder = folder_;
  }
  // Writes noise that is opaque in the columns from `begin` on and transparent in the others.
  // Transparent pixels have the colour `beneath`; if it is not given, they keep their noise.
  void Write(int index, int begin, std::optional<uint8_t> beneath) {
    Image<uint8_t> image = NoiseImage<uint8_t>(kSide, kSide, 4);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        image.at(x, y, 3) = x < begin ? 0 : 255;
        for (int c = 0; c < 3 && x < begin && beneath; ++c) image.at(x, y, c) = *beneath;
      }
    ASSERT_TRUE(WriteImage(folder_ / field_.image_names[index], image.view()));
  }

  LightField field_;
};

TEST_F(AlphaEvidenceTest, WithoutAlphaThereIsNone) {
  EXPECT_FALSE(FindAlphaEvidence(field_));  // no files, no evidence
  const Image<uint8_t> image(kSide, kSide, 3);
  ASSERT_TRUE(WriteImage(folder_ / "0.png", image.view()));
  EXPECT_FALSE(FindAlphaEvidence(field_));
  Write(1, 0, {});
  EXPECT_FALSE(FindAlphaEvidence(field_)) << "nothing is transparent";
}

TEST_F(AlphaEvidenceTest, AnObjectAloneIsLightOverWhatIsBeneath) {
  Write(0, 5, 255);
  Write(1, 9, 255);
  Write(2, 7, 255);
  const auto found = FindAlphaEvidence(field_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_EQ(found->background, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(found->image_name, "0.png");
}

TEST_F(AlphaEvidenceTest, OneImageOfAnObjectIsEnough) {
  Write(1, 9, 0);
  const auto found = FindAlphaEvidence(field_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_EQ(found->background, (std::array<double, 3>{0, 0, 0}));
}

TEST_F(AlphaEvidenceTest, AMaskedPhotographDecidesForAll) {
  Write(0, 5, 0);
  Write(1, 9, {});
  const auto found = FindAlphaEvidence(field_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->meaning, AlphaMeaning::kMask);
  EXPECT_EQ(found->image_name, "1.png");
}

TEST_F(AlphaEvidenceTest, OtherColoursNearOutlinesDoNotMatter) {
  const int begins[] = {9, 7, 11};
  for (const int i : {0, 1, 2}) {
    Image<uint8_t> image = NoiseImage<uint8_t>(kSide, kSide, 4);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        image.at(x, y, 3) = x < begins[i] ? 0 : 255;
        for (int c = 0; c < 3 && x < begins[i] - 2; ++c) image.at(x, y, c) = 255;
      }
    ASSERT_TRUE(WriteImage(folder_ / field_.image_names[static_cast<size_t>(i)], image.view()));
  }
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_TRUE(found->is_sure);
  EXPECT_EQ(found->background, (std::array<double, 3>{1, 1, 1}));
}

TEST_F(AlphaEvidenceTest, ColoursThatFallWithAlphaArePremultiplied) {
  for (const bool is_multiplied : {true, false}) {
    Image<uint8_t> image(kSide, kSide, 4);
    for (int y = 0; y < kSide; ++y)
      for (int x = 8; x < kSide; ++x) {
        image.at(x, y, 3) = x < 10 ? 100 : 255;
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = x < 10 && is_multiplied ? 80 : 200;
      }
    ASSERT_TRUE(WriteImage(folder_ / "0.png", image.view()));
    EXPECT_EQ(FindAlphaEvidence(field_)->meaning,
              is_multiplied ? AlphaMeaning::kPremultiplied : AlphaMeaning::kStraight);
  }
}

TEST_F(AlphaEvidenceTest, AHiddenPictureWithoutDetailIsDoubted) {
  Image<uint8_t> image = NoiseImage<uint8_t>(kSide, kSide, 4);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      image.at(x, y, 3) = x < 15 ? 0 : 255;
      for (int c = 0; c < 3 && x < 15; ++c) image.at(x, y, c) = static_cast<uint8_t>(10 * y);
    }
  ASSERT_TRUE(WriteImage(folder_ / "0.png", image.view()));
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kMask);
  EXPECT_FALSE(found->is_sure);
}

TEST_F(AlphaEvidenceTest, AnObjectWithTheSameOutlineInAllImagesIsDoubted) {
  Image<uint8_t> image(kSide, kSide, 4);
  for (int y = 5; y < 15; ++y)
    for (int x = 5; x < 15; ++x)
      for (int c = 0; c < 4; ++c) image.at(x, y, c) = 255;
  for (const std::string& name : field_.image_names)
    ASSERT_TRUE(WriteImage(folder_ / name, image.view()));
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_FALSE(found->is_sure);
}

TEST_F(AlphaEvidenceTest, ABorderThatAllHaveIsAMask) {
  for (const int i : {0, 1, 2}) Write(i, 5, 0);
  EXPECT_EQ(FindAlphaEvidence(field_)->meaning, AlphaMeaning::kMask);
}

TEST_F(AlphaEvidenceTest, ImagesThatAreMostlyOpaqueAreDoubted) {
  Write(0, 3, 0);
  Write(1, 5, 0);
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kMask);
  EXPECT_FALSE(found->is_sure);
  Write(2, 10, 0);  // half of this one is transparent
  EXPECT_EQ(FindAlphaEvidence(field_)->meaning, AlphaMeaning::kStraight);
}

// Writes an image whose columns 0 to 7 are transparent, 8 to 11 half transparent, and then opaque.
void WriteSoft(const std::filesystem::path& file, uint8_t half, uint8_t alpha, uint8_t opaque) {
  Image<uint8_t> image(kSide, kSide, 4);
  for (int y = 0; y < kSide; ++y)
    for (int x = 8; x < kSide; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = x < 12 ? half : 200;
      image.at(x, y, 3) = x < 12 ? alpha : opaque;
    }
  ASSERT_TRUE(WriteImage(file, image.view()));
}

TEST_F(AlphaEvidenceTest, BlackShadowsTellNothing) {
  WriteSoft(folder_ / "0.png", 0, 100, 255);
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_FALSE(found->is_sure);
}

TEST_F(AlphaEvidenceTest, WithoutOpaquePixelsColoursAreDoubted) {
  WriteSoft(folder_ / "0.png", 90, 100, 150);
  const auto found = FindAlphaEvidence(field_);
  EXPECT_EQ(found->meaning, AlphaMeaning::kStraight);
  EXPECT_FALSE(found->is_sure);
}

TEST_F(AlphaEvidenceTest, FloatsOverBlackArePremultiplied) {
  field_.image_names[0] = "0.exr";
  Image<float> image(kSide, kSide, 4);
  image.at(3, 3, 0) = image.at(3, 3, 3) = 1;
  ASSERT_TRUE(WriteImage(folder_ / "0.exr", image.view(), {"R", "G", "B", "A"}, PixelType::kFloat));
  EXPECT_EQ(FindAlphaEvidence(field_)->meaning, AlphaMeaning::kPremultiplied);
  for (float& value : image.pixels()) value = 1;
  image.at(4, 4, 0) = std::numeric_limits<float>::quiet_NaN();
  image.at(4, 4, 3) = 0;
  ASSERT_TRUE(WriteImage(folder_ / "0.exr", image.view(), {"R", "G", "B", "A"}, PixelType::kFloat));
  EXPECT_EQ(FindAlphaEvidence(field_)->background, (std::array<double, 3>{0, 1, 1}));
}

}  // namespace
}  // namespace lf
