// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/group_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "lf/distribute/compress/image_groups.h"
#include "lf/distribute/compress/test_drawn_capture.h"
#include "lf/pixels/codec/predicted_image.h"

namespace lf {
namespace {

class GroupCoderTest : public DrawnCaptureTest {
 protected:
  // Encodes all groups of the capture.
  std::vector<CodedGroup> Encode(uint32_t left_out = 0) {
    const ImageCoder coder(source_.light_field.encoding, settings_, KeepFiles::kNone, {});
    const ThresholdFactors factors;
    const GroupCoder group_coder(source_, coder, factors, {});
    const ReferenceGroups groups = GroupsOf(source_);
    std::vector<CodedGroup> coded;
    for (size_t g = 0; g < groups.size(); ++g)
      coded.push_back(group_coder.Encode(groups.Group(g), {}, left_out).value());
    return coded;
  }
  static uint64_t AloneBytes(const CodedGroup& group) {
    return std::accumulate(group.bytes_alone.begin(), group.bytes_alone.end(), uint64_t{0});
  }
  // Decodes a group as a reader does, and compares with the files and the errors that were stated.
  void ExpectDecodes(const CodedGroup& group) {
    const ImageCoder coder(source_.light_field.encoding, settings_, KeepFiles::kNone, {});
    std::map<uint32_t, DecodedPart> decoded;
    for (const CodedMember& member : group.members) {
      std::vector<const DecodedPart*> references;
      for (const LfImageId reference : member.image.references)
        references.push_back(&decoded.at(reference.value));
      const PixelRect whole = {0, 0, member.image.rect.width(), member.image.rect.height()};
      DecodedPart& part = decoded[member.id.value];
      ASSERT_TRUE(DecodePredicted(member.image.code, references, whole, &part));
      const RecordedImage image =
          ReadRecordedImage(source_.light_field, member.id, member.image.rect).value();
      const CodeError error = coder.ErrorOf(image, member.image.values, part);
      EXPECT_EQ(error.squared, member.lost.squared);
      EXPECT_EQ(error.count, member.lost.count);
      if (settings_.profile == CodecProfile::kLossless) {
        EXPECT_EQ(error.squared, 0);
      }
    }
  }
  static size_t PredictedCount(const CodedGroup& group) {
    return static_cast<size_t>(
        std::count_if(group.members.begin(), group.members.end(),
                      [](const CodedMember& member) { return !member.image.references.empty(); }));
  }

  CodecSettings settings_;
};

TEST_F(GroupCoderTest, ImagesOfAllKindsArePredictedAndDecoded) {
  const auto check = [&](double most_share) {
    for (const CodecProfile profile : {CodecProfile::kDefault, CodecProfile::kLossless}) {
      settings_.profile = profile;
      const std::vector<CodedGroup> groups = Encode();
      ASSERT_EQ(groups.size(), 1U);
      const CodedGroup& group = groups[0];
      ASSERT_EQ(group.members.size(), static_cast<size_t>(kColumns * kRows));
      EXPECT_TRUE(group.unreadable.empty());
      EXPECT_GT(PredictedCount(group), 14U);
      EXPECT_LT(static_cast<double>(group.bytes),
                most_share * static_cast<double>(AloneBytes(group)));
      ExpectDecodes(group);
    }
  };
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  check(0.7);
  MakeCapture<uint16_t>(PixelLayout::kGrey);
  check(0.8);
  MakeCapture<uint8_t>(PixelLayout::kMosaic);
  check(0.8);
}

TEST_F(GroupCoderTest, EqualInputsGiveEqualBytes) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  const CodedGroup first = Encode()[0], second = Encode()[0];
  ASSERT_EQ(first.members.size(), second.members.size());
  for (size_t i = 0; i < first.members.size(); ++i) {
    EXPECT_EQ(first.members[i].id, second.members[i].id);
    EXPECT_EQ(first.members[i].image.code, second.members[i].image.code);
    EXPECT_EQ(first.members[i].image.references, second.members[i].image.references);
  }
}

TEST_F(GroupCoderTest, PartsOfImagesArePredicted) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  // Parts of equal size at different places.
  for (int i = 0; i < kColumns * kRows; ++i)
    source_.rects[static_cast<size_t>(i)] = {i % 7, i % 5, 80 + i % 7, 60 + i % 5};
  const CodedGroup group = Encode()[0];
  EXPECT_GT(PredictedCount(group), 14U);
  EXPECT_LT(static_cast<double>(group.bytes), 0.75 * static_cast<double>(AloneBytes(group)));
  ExpectDecodes(group);
}

TEST_F(GroupCoderTest, PartsOfDifferentSizesShareAGroup) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  // As --needed-pixels asks for, when a camera moves.
  for (int i = 0; i < kColumns * kRows; ++i)
    source_.rects[static_cast<size_t>(i)] = {i % 7, i % 5, 80 + i % 16, 60 + i % 12};
  const std::vector<CodedGroup> groups = Encode();
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_GT(PredictedCount(groups[0]), 14U);
  EXPECT_LT(static_cast<double>(groups[0].bytes),
            0.75 * static_cast<double>(AloneBytes(groups[0])));
  ExpectDecodes(groups[0]);
}

TEST_F(GroupCoderTest, ExposuresOfBracketsHaveGroupsOfTheirOwn) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  for (size_t i = 1; i < source_.light_field.size(); i += 2)
    source_.light_field.cameras[i].gain = 4;
  const ReferenceGroups groups = GroupsOf(source_);
  ASSERT_GE(groups.size(), 2U);
  for (size_t g = 0; g < groups.size(); ++g)
    for (const GroupMember& member : groups.Group(g))
      EXPECT_EQ(member.id.value % 2, groups.Group(g)[0].id.value % 2) << g;
}

TEST_F(GroupCoderTest, AnImageThatCannotBeReadIsLeftOut) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  const ReferenceGroups groups = GroupsOf(source_);
  for (const size_t rank : {size_t{0}, size_t{2}, size_t{15}}) {
    MakeCapture<uint8_t>(PixelLayout::kRgb);
    const LfImageId broken = groups.Group(0)[rank].id;
    const CodedGroup left_out = Encode(1U << rank)[0];
    std::filesystem::resize_file(source_.light_field.ImagePath(broken), 30);
    const CodedGroup group = Encode()[0];
    ASSERT_EQ(group.unreadable.size(), 1U);
    EXPECT_EQ(group.unreadable[0].id, broken);
    EXPECT_EQ(group.unreadable[0].error.kind, ErrorKind::kInput);
    ASSERT_EQ(group.members.size(), static_cast<size_t>(kColumns * kRows) - 1);
    for (size_t i = 0; i < group.members.size(); ++i) {
      const CodedImage& image = group.members[i].image;
      EXPECT_EQ(std::count(image.references.begin(), image.references.end(), broken), 0);
      EXPECT_EQ(image.code, left_out.members[i].image.code);
    }
    EXPECT_TRUE(left_out.unreadable.empty());
    ExpectDecodes(group);
  }
}

// The files of the capture show different things each.
TEST_F(GroupCoderTest, ImagesThatDoNotPredictEachOtherAreEncodedAlone) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  for (uint32_t i = 0; i < source_.light_field.size(); ++i)
    ASSERT_TRUE(
        WriteImage(source_.light_field.ImagePath({i}),
                   DrawnView<uint8_t>(10 * i, 7 * i, kWidth, kHeight, PixelLayout::kRgb).view()));
  const ImageCoder coder(source_.light_field.encoding, settings_, KeepFiles::kNone, {});
  const CodedGroup group = Encode()[0];
  EXPECT_EQ(PredictedCount(group), 0U);
  for (const CodedMember& member : group.members) {
    const RecordedImage image =
        ReadRecordedImage(source_.light_field, member.id, member.image.rect).value();
    EXPECT_EQ(member.image.code, coder.Code(image)->code);
    EXPECT_FALSE(member.image.front_ends.empty());
  }
  EXPECT_EQ(group.bytes, AloneBytes(group));
  ExpectDecodes(group);
}

TEST_F(GroupCoderTest, AnImageOfAnotherKindIsNoReferenceImage) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  const ReferenceGroups groups = GroupsOf(source_);
  const LfImageId key = groups.Group(0)[0].id, leaf = groups.Group(0)[18].id;
  ASSERT_TRUE(WriteImage(source_.light_field.ImagePath(key),
                         DrawnView<uint16_t>(0, 0, kWidth, kHeight, PixelLayout::kRgb).view()));
  ASSERT_TRUE(WriteImage(source_.light_field.ImagePath(leaf),
                         DrawnView<uint8_t>(0, 0, kWidth, kHeight, PixelLayout::kGrey).view()));
  const CodedGroup group = Encode()[0];
  EXPECT_GT(PredictedCount(group), 12U);
  for (const CodedMember& member : group.members) {
    const std::vector<LfImageId>& references = member.image.references;
    EXPECT_EQ(std::count(references.begin(), references.end(), key), 0);
    if (member.id == leaf || member.id == key) {
      EXPECT_TRUE(references.empty());
    }
  }
  ExpectDecodes(group);
}

TEST_F(GroupCoderTest, StepsAreEqualIfImagesAreNoisy) {
  // Returns the error of the key image, divided by that of an image encoded alone with the same
  // settings.
  const auto key_error = [&](double noise) {
    MakeCapture<uint8_t>(PixelLayout::kRgb, noise);
    const CodedMember key = Encode()[0].members[0];
    const ImageCoder coder(source_.light_field.encoding, settings_, KeepFiles::kNone, {});
    const RecordedImage image =
        ReadRecordedImage(source_.light_field, key.id, key.image.rect).value();
    return key.lost.squared / coder.ErrorOf(image, *coder.Code(image))->squared;
  };
  settings_.threshold = 6;
  EXPECT_LT(key_error(0), 0.7);
  EXPECT_EQ(key_error(0.016), 1);
}

TEST_F(GroupCoderTest, AnInterruptionEndsAGroup) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  size_t done = 0;
  const ImageCoder coder(source_.light_field.encoding, settings_, KeepFiles::kNone, {});
  const ThresholdFactors factors;
  const GroupCoder group_coder(source_, coder, factors, [&] { return done >= 5; });
  const ReferenceGroups groups = GroupsOf(source_);
  const Result<CodedGroup> coded = group_coder.Encode(groups.Group(0), [&] { ++done; });
  ASSERT_FALSE(coded);
  EXPECT_EQ(coded.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(done, 5U);
}

TEST(NoiseOf, IsTheDeviationOfNoiseInSmoothPlaces) {
  for (const double deviation : {0.0, 2.0, 5.0}) {
    Image<uint8_t> image(200, 150);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        const auto index = static_cast<uint64_t>(y * 1000 + x) * 12;
        double sum = -6;
        for (uint64_t i = 0; i < 12; ++i) sum += RandomUnit(9, 0, index + i);
        // A slope on the left, fine detail on the right.
        const double value = x < 100 ? 40 + x : 128 + 60 * std::sin(1.3 * x) * std::sin(1.7 * y);
        image.at(x, y) = static_cast<uint8_t>(std::lround(value + deviation * sum));
      }
    EXPECT_LE(NoiseOf(image), deviation + 0.3);
    EXPECT_GE(NoiseOf(image), 0.7 * deviation);
  }
  EXPECT_EQ(NoiseOf(Image<uint8_t>(3, 3)), 0);
}

}  // namespace
}  // namespace lf
