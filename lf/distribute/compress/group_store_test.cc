// SPDX-License-Identifier: Apache-2.0
// Tests packed stores that are made of groups of LF images.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/parallel.h"
#include "lf/distribute/compress/codec_words.h"
#include "lf/distribute/compress/compress.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/distribute/compress/test_drawn_capture.h"
#include "lf/storage/load/folder_store.h"
#include "lf/storage/load/packed_store.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {
namespace {

class GroupStoreTest : public DrawnCaptureTest {
 protected:
  void SetUp() override {
    DrawnCaptureTest::SetUp();
    store_ = folder_ / "store.lfs";
    ASSERT_TRUE(SetCodec({.profile = "group"}, &options_));
    options_.store = store_;
  }
  Result<CompressReport> Make(const std::function<void(const CompressProgress&)>& progress = {}) {
    ThreadPool pool(3);
    return Compress(source_, options_, pool, progress);
  }
  // Returns the encoded images of the store, by LF image.
  std::map<uint32_t, std::string> Codes() const {
    std::map<uint32_t, std::string> all;
    const LightField stored = ReadPackedStore(store_).value().light_field;
    PackedCodeReader reader = PackedCodeReader::Open(store_).value();
    const std::vector<PackedCode> codes = FindCodes(store_, stored).value();
    for (uint32_t id = 0; id < codes.size(); ++id)
      if (codes[id].bytes > 0) all[id] = std::string(reader.Read(codes[id])->code);
    return all;
  }
  // Checks that all LF images are loaded with the pixels of their files.
  void ExpectThePixelsOfTheFiles(uint64_t kept_bytes) const {
    const LightField stored = ReadPackedStore(store_).value().light_field;
    const FolderStore files(source_.light_field, Mosaics::kAsRecorded);
    const auto packed = PackedStore::Open(stored, Mosaics::kAsRecorded).value();
    packed->LimitReferences(kept_bytes);
    for (uint32_t i = 0; i < stored.size(); ++i) {
      // From the last one on, so that those that need others come first.
      const LfImageId id = {static_cast<uint32_t>(stored.size()) - 1 - i};
      LfPixels loaded, expected;
      ASSERT_TRUE(packed->Load(id, {0, 0, kWidth, kHeight}, &loaded));
      ASSERT_TRUE(files.Load(id, {0, 0, kWidth, kHeight}, &expected));
      EXPECT_EQ(loaded.radiance.pixels(), expected.radiance.pixels()) << id.value;
    }
  }

  std::filesystem::path store_;
  CompressOptions options_;
};

TEST_F(GroupStoreTest, LosslessGroupsHaveThePixelsOfTheFiles) {
  ASSERT_TRUE(SetCodec({.profile = "group-lossless"}, &options_));
  options_.verify = true;
  options_.overwrite = true;
  for (const uint64_t shard_bytes : {0, 20000}) {
    options_.shard_bytes = shard_bytes;
    MakeCapture<uint8_t>(PixelLayout::kRgb);
    const Result<CompressReport> report = Make();
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->coded_count, source_.light_field.size());
    EXPECT_GT(report->predicted_count, 14U);
    EXPECT_EQ(report->error.squared, 0);
    EXPECT_EQ(report->verified_count, source_.light_field.size());
    EXPECT_EQ(ReadReferences(store_)->predicted_count(), report->predicted_count);
    ExpectThePixelsOfTheFiles(0);
    ExpectThePixelsOfTheFiles(uint64_t{1} << 30);
  }
}

TEST_F(GroupStoreTest, AnInterruptedStoreIsResumedToTheSameBytes) {
  MakeCapture<uint16_t>(PixelLayout::kRgb);
  ASSERT_TRUE(Make());
  const std::map<uint32_t, std::string> whole = Codes();
  const size_t count = source_.light_field.size();
  EXPECT_EQ(whole.size(), count);
  std::filesystem::remove(store_);
  options_.resume = true;
  // The capture is one group: an interruption leaves nothing of it.
  std::atomic<bool> interrupted = false;
  options_.interrupted = &interrupted;
  const Result<CompressReport> stopped =
      Make([&](const CompressProgress& now) { interrupted = now.done >= 7; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(stopped.error().message.find("interrupted after 0 of 20"), 0U)
      << stopped.error().message;
  interrupted = false;
  options_.verify = true;
  const Result<CompressReport> report = Make();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(Codes(), whole);
}

TEST_F(GroupStoreTest, AnImageThatBecomesReadableIsAddedAlone) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  const LfImageId broken = GroupsOf(source_).Group(0)[1].id;
  const std::filesystem::path file = source_.light_field.ImagePath(broken);
  const std::string bytes = ReadFile(file).value();
  std::filesystem::resize_file(file, 30);
  // The store is left unfinished, as after a kill behind the group.
  options_.resume = true;
  options_.strict = true;
  ASSERT_FALSE(Make());
  options_.strict = false;
  ASSERT_TRUE(WriteFileAtomically(file, bytes));
  options_.verify = true;
  const Result<CompressReport> report = Make();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->skipped.empty());
  EXPECT_EQ(report->coded_count + report->resumed_count, source_.light_field.size());
  const ReferenceTable references = ReadReferences(store_).value();
  EXPECT_FALSE(references.IsPredicted(broken.value));
  EXPECT_FALSE(references.IsReference(broken.value));
}

TEST_F(GroupStoreTest, VerifyFindsAnotherPicture) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  ASSERT_TRUE(Make());
  options_.verify = true;
  EXPECT_TRUE(Make());
  const LfImageId leaf = GroupsOf(source_).Group(0)[17].id;
  ASSERT_TRUE(WriteImage(source_.light_field.ImagePath(leaf),
                         DrawnView<uint8_t>(9, 9, kWidth, kHeight, PixelLayout::kRgb).view()));
  const Result<CompressReport> wrong = Make();
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, ErrorKind::kInput);
  EXPECT_NE(wrong.error().message.find("1 of 20 LF images are wrong in the store"),
            std::string::npos)
      << wrong.error().message;
}

TEST_F(GroupStoreTest, ABrokenImageIsLeftOutAndNamed) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  const LfImageId broken = GroupsOf(source_).Group(0)[0].id;
  std::filesystem::resize_file(source_.light_field.ImagePath(broken), 30);
  options_.verify = true;
  const Result<CompressReport> report = Make();
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->skipped.size(), 1U);
  EXPECT_EQ(report->skipped[0].name, source_.light_field.image_names[broken.value]);
  EXPECT_EQ(report->coded_count, source_.light_field.size() - 1);
}

TEST_F(GroupStoreTest, TheThresholdIsFoundForAQuality) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  for (const double psnr_db : {40.0, 46.0}) {
    options_.target_psnr_db = psnr_db;
    options_.overwrite = true;
    const Result<CompressReport> report = Make();
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_GE(report->error.PsnrDb(), psnr_db);
    EXPECT_LT(report->error.PsnrDb(), psnr_db + 1);
  }
}

TEST_F(GroupStoreTest, AnInterruptedChoiceOfAProfileLeavesNothing) {
  ASSERT_TRUE(SetCodec({.profile = "auto"}, &options_));
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  for (const size_t moment : {size_t{0}, size_t{3}, source_.light_field.size()}) {
    std::atomic<bool> interrupted = false;
    options_.interrupted = &interrupted;
    const Result<CompressReport> report = Make([&](const CompressProgress& now) {
      if (now.phase == CompressPhase::kChoosing && now.done == moment) interrupted = true;
    });
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().kind, ErrorKind::kInterrupted);
    if (moment < source_.light_field.size()) {
      EXPECT_EQ(report.error().message, "interrupted during the choice of a profile");
      EXPECT_FALSE(PackedStoreWriter::IsUnfinished(store_));
    }
    EXPECT_FALSE(std::filesystem::exists(store_));
  }
}

// The groups of the sample are broken; another one, which is not looked at, is not.
TEST_F(GroupStoreTest, ASampleThatCannotBeReadGivesNoThreshold) {
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  LightField& field = source_.light_field;
  for (uint32_t i = 0; i < field.size(); ++i)
    field.cameras[i].gain = ChannelGains(i < 7 ? 1.0f : i < 14 ? 4.0f : 16.0f);
  source_.whole = IdentityOf(field);
  const ReferenceGroups groups = GroupsOf(source_);
  ASSERT_EQ(groups.size(), 3U);
  const std::vector<size_t> sample = SampleOf(groups, 12);
  ASSERT_EQ(sample.size(), 2U);
  for (const size_t group : sample)
    for (const GroupMember& member : groups.Group(group))
      std::filesystem::resize_file(field.ImagePath(member.id), 30);
  options_.target_psnr_db = 42;
  const Result<CompressReport> report = Make();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::kInput);
  EXPECT_NE(report.error().message.find("LF images that were tried can be read"), std::string::npos)
      << report.error().message;
}

TEST_F(GroupStoreTest, AutoChoosesByASample) {
  ASSERT_TRUE(SetCodec({.profile = "auto"}, &options_));
  options_.overwrite = true;
  options_.verify = true;
  MakeCapture<uint8_t>(PixelLayout::kRgb);
  std::vector<CompressProgress> told;
  Result<CompressReport> report = Make([&](const CompressProgress& now) { told.push_back(now); });
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->codec, "default, levels 4, threshold 3, coded by contexts, in groups");
  // Each phase tells its beginning, and each LF image; the last one each group, of which there is
  // one.
  const size_t count = source_.light_field.size();
  ASSERT_EQ(told.size(), 2 * (count + 1) + 2);
  for (size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(static_cast<size_t>(told[i].phase), i / (count + 1));
    EXPECT_EQ(told[i].done, i + 1 == told.size() ? count : i % (count + 1));
    EXPECT_EQ(told[i].total, count);
  }
  ASSERT_TRUE(report->sample);
  EXPECT_EQ(report->sample->image_count, source_.light_field.size());
  EXPECT_LT(report->sample->in_groups, report->sample->alone);

  // Pictures that do not predict each other.
  for (uint32_t i = 0; i < source_.light_field.size(); ++i)
    ASSERT_TRUE(
        WriteImage(source_.light_field.ImagePath({i}),
                   DrawnView<uint8_t>(10 * i, 7 * i, kWidth, kHeight, PixelLayout::kRgb).view()));
  report = Make();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->codec, "default, levels 4, threshold 3, or the image file if it is smaller");
  EXPECT_EQ(report->predicted_count, 0U);

  // The files of random stripes are smaller than their encoded images.
  for (uint32_t i = 0; i < source_.light_field.size(); ++i) {
    Image<uint8_t> stripes(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < 3 * kWidth; ++x)
        stripes.row(y)[x] = static_cast<uint8_t>(255 * RandomUnit(5, i, static_cast<uint64_t>(x)));
    ASSERT_TRUE(WriteImage(source_.light_field.ImagePath({i}), stripes.view()));
  }
  report = Make();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->sample->FilesAreBetter());
  EXPECT_EQ(report->codec, "lossless, levels 4, or the image file");
  EXPECT_EQ(report->file_count, source_.light_field.size());
}

}  // namespace
}  // namespace lf
