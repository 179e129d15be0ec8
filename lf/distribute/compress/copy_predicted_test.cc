// SPDX-License-Identifier: Apache-2.0
// Tests copies of packed stores of predicted LF images.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/parallel.h"
#include "lf/distribute/compress/compress.h"
#include "lf/storage/load/packed_store.h"
#include "lf/storage/load/test_predicted_store.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {
namespace {

class CopyPredictedTest : public ::testing::Test {
 protected:
  CopyPredictedTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("lf_copy_predicted_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
    from_ = folder_ / "from.lfs";
    options_.store = folder_ / "to.lfs";
    options_.verify = true;
    images_ = MakePredictedImages({.has_masks = true});
  }
  ~CopyPredictedTest() override { std::filesystem::remove_all(folder_); }

  void Write() {
    images_.Write(from_);
    field_ = ReadPackedStore(from_).value().light_field;
  }
  Result<CompressReport> Copy(const CompressSource& source,
                              const std::function<void(const CompressProgress&)>& progress = {}) {
    ThreadPool pool(3);
    return Compress(source, options_, pool, progress);
  }
  // Checks the LF images of the copy.
  //   ids  those that it has
  void ExpectCopied(const std::vector<uint32_t>& ids) {
    const LightField copied = ReadPackedStore(options_.store).value().light_field;
    const auto store = PackedStore::Open(copied, Mosaics::kAsRecorded).value();
    const auto original = PackedStore::Open(field_, Mosaics::kAsRecorded).value();
    const ReferenceTable references = ReadReferences(options_.store).value();
    for (uint32_t id = 0; id < kPredictedImages; ++id) {
      const bool is_copied = std::find(ids.begin(), ids.end(), id) != ids.end();
      EXPECT_EQ(store->IsThere({id}), is_copied) << id;
      if (!is_copied) continue;
      const auto found = references.Of(id);
      EXPECT_EQ(std::vector<uint32_t>(found.begin(), found.end()), kReferencesOfImages[id]);
      LfPixels loaded, expected;
      const PixelRect rect = {0, 0, images_.kind.width, images_.kind.height};
      ASSERT_TRUE(store->Load({id}, rect, &loaded));
      ASSERT_TRUE(original->Load({id}, rect, &expected));
      EXPECT_EQ(loaded.radiance.pixels(), expected.radiance.pixels());
    }
  }
  // Returns the LF images of a package of which frames take rays from these.
  Result<CompressSource> SourceOf(const std::vector<uint32_t>& ids, bool needed_pixels = false) {
    Package package;
    package.name = "package";
    package.light_field = field_;
    package.whole = ReadWholeIdentity(from_).value();
    for (const uint32_t id : ids) {
      PackageImage image;
      image.id = id;
      image.rect = {10, 10, 20, 20};
      image.ray_count = 5;
      package.images.push_back(image);
    }
    return SourceOfPackages(field_, std::vector<Package>{package}, needed_pixels);
  }

  const std::filesystem::path folder_;
  std::filesystem::path from_;
  CompressOptions options_;
  PredictedImages images_;
  LightField field_;
};

TEST_F(CopyPredictedTest, AllAreCopied) {
  Write();
  const CompressSource source = SourceOfAll(field_).value();
  for (const uint64_t shard_bytes : {0, 2000, 9000}) {
    options_.shard_bytes = shard_bytes;
    options_.overwrite = true;
    const auto report = Copy(source);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->coded_count, kPredictedImages);
    EXPECT_EQ(report->verified_count, size_t{kPredictedImages});
    ExpectCopied({0, 1, 2, 3, 4, 5, 6});
  }
}

// An interrupted copy has the reference images of each LF image that it has, and is resumed.
TEST_F(CopyPredictedTest, AnInterruptedCopyIsResumed) {
  Write();
  const CompressSource source = SourceOfAll(field_).value();
  for (size_t after = 1; after < kPredictedImages; ++after) {
    std::filesystem::remove(options_.store);
    std::atomic<bool> interrupted = false;
    options_.interrupted = &interrupted;
    options_.resume = false;
    const auto first = Copy(source, [&](const CompressProgress& now) {
      if (now.done >= after) interrupted = true;
    });
    ASSERT_FALSE(first);
    EXPECT_EQ(first.error().kind, ErrorKind::kInterrupted);
    interrupted = false;
    options_.resume = true;
    const auto second = Copy(source);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->resumed_count, after);
    ExpectCopied({0, 1, 2, 3, 4, 5, 6});
  }
}

TEST_F(CopyPredictedTest, PackagesNeedReferenceImages) {
  Write();
  struct Needed {
    std::vector<uint32_t> ids, copied;
  };
  for (const Needed& needed : {Needed{{2}, {2}}, Needed{{0}, {0, 3, 5}},
                               Needed{{4, 2}, {0, 2, 3, 4, 5}}, Needed{{6}, {0, 1, 3, 4, 5, 6}}}) {
    std::filesystem::remove(options_.store);
    const auto source = SourceOf(needed.ids);
    ASSERT_TRUE(source) << source.error().message;
    const auto report = Copy(*source);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->image_count, needed.copied.size());
    EXPECT_EQ(report->left_out_count, kPredictedImages - needed.copied.size());
    ExpectCopied(needed.copied);
    // A copy of the copy has the same LF images.
    const LightField copied = ReadPackedStore(options_.store).value().light_field;
    EXPECT_EQ(SourceOfAll(copied).value().CompressedIds().size(), needed.copied.size());
  }
}

TEST_F(CopyPredictedTest, OthersAreRefused) {
  Write();
  const auto parts = SourceOf({6}, true);
  ASSERT_FALSE(parts);
  EXPECT_EQ(parts.error().kind, ErrorKind::kUsage);
  options_.by_resolution = true;
  const auto report = Copy(SourceOfAll(field_).value());
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::kUsage);
  EXPECT_NE(report.error().message.find("predicted from others, which have no smaller pictures"),
            std::string::npos)
      << report.error().message;
}

// LF images that are predicted from a damaged one are left out, and no others.
TEST_F(CopyPredictedTest, DamageIsNotCopied) {
  images_.coded[0].code += "a mark to be found";
  Write();
  std::string file = *ReadFile(from_);
  const size_t at = file.find("a mark to be found");
  ASSERT_NE(at, std::string::npos);
  file[at] = 'A';
  ASSERT_TRUE(WriteFileAtomically(from_, file));
  options_.verify = false;
  const auto report = Copy(SourceOfAll(field_).value());
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->skipped.size(), 4u);
  EXPECT_EQ(report->skipped[0].name, "image0.png");
  EXPECT_NE(report->skipped[0].reason.find("checksum"), std::string::npos);
  EXPECT_NE(report->skipped[1].reason.find("image1.png: is predicted from image4.png, which"),
            std::string::npos)
      << report->skipped[1].reason;
  const ReferenceTable references = ReadReferences(options_.store).value();
  EXPECT_TRUE(references.empty());
  const LightField copied = ReadPackedStore(options_.store).value().light_field;
  const auto store = PackedStore::Open(copied, Mosaics::kAsRecorded).value();
  for (uint32_t id = 0; id < kPredictedImages; ++id)
    EXPECT_EQ(store->IsThere({id}), id == 2 || id == 3 || id == 5) << id;
}

}  // namespace
}  // namespace lf
