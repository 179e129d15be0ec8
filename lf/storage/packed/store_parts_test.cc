// SPDX-License-Identifier: Apache-2.0
// Tests stores by resolution: what they hold, and what is left of them if files are missing or were
// not copied to their end.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "lf/camera/testing_scenes.h"
#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/part_file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kImages = 12;

// Every image has two, three or four fronts; image 3 is of half floats, and image 5 has a mask.
CodedImage ImageWithFronts(uint32_t i) {
  CodedImage image;
  image.values = i == 3 ? StoredValues::kHalf : StoredValues::kUint8;
  image.rect = {0, 0, 60, 41};
  for (uint64_t k = 0; k < 2000 + 10 * i; ++k) image.code += static_cast<char>(RandomBits(4, i, k));
  if (i == 5)
    image.mask = "the mask";
  else if (i % 3 == 0)
    image.front_ends = {100, 300 + i, 900, 1500};
  else if (i % 3 == 1)
    image.front_ends = {200 + i, 700, 1400};
  else
    image.front_ends = {250, 1000};
  return image;
}

class StorePartsTest : public ::testing::Test {
 protected:
  StorePartsTest()
      : folder_(fs::temp_directory_path() /
                ("lf_store_parts_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "a.lfs") {
    fs::create_directories(folder_);
    for (uint32_t i = 0; i < kImages; ++i) {
      const testing::CameraPair pair = testing::RandomDistortedPair(i);
      field_.intrinsics.push_back(pair.lf_camera.intrinsics);
      field_.cameras.push_back({pair.lf_camera.cam_from_world, i, 1.0f});
      field_.image_names.push_back("image " + std::to_string(i) + ".png");
    }
    plan_.whole = {kImages, "0123456789abcdef", "fedcba9876543210"};
    plan_.codec = "lossless";
    plan_.part_count = 4;
  }
  ~StorePartsTest() override { fs::remove_all(folder_); }

  void Write() {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    // From the last one on, because any order is right.
    for (uint32_t i = kImages; i-- > 0;) ASSERT_TRUE(writer.Add({i}, ImageWithFronts(i)));
    const Result<void> finished = writer.Finish();
    ASSERT_TRUE(finished) << finished.error().message;
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  void ExpectHoldsAll() {
    const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    for (uint32_t i = 0; i < kImages; ++i) {
      const CodedImage expected = ImageWithFronts(i);
      EXPECT_EQ(codes[i].missing_parts, 0);
      const auto bytes = reader.Read(codes[i]);
      ASSERT_TRUE(bytes) << bytes.error().message;
      EXPECT_EQ(bytes->code, expected.code);
      EXPECT_EQ(bytes->mask, expected.mask);
    }
  }
  std::string Fault() const {
    const auto facts = ReadPackedStore(path_);
    EXPECT_FALSE(facts);
    return facts ? "" : facts.error().message;
  }
  fs::path Part(size_t number) const { return PartPath(path_, number); }

  fs::path folder_, path_;
  LightField field_;
  PackedStorePlan plan_;
};

const std::vector<std::string> kAllFiles = {"a-r0.lfs", "a-r1.lfs", "a-r2.lfs", "a-r3.lfs",
                                            "a.lfs"};

TEST_F(StorePartsTest, HoldsWhatWasWritten) {
  Write();
  EXPECT_EQ(Files(), kAllFiles);
  const PackedStoreFacts facts = ReadPackedStore(path_).value();
  EXPECT_EQ(facts.part_count, 4u);
  EXPECT_EQ(facts.found_parts, 4u);
  EXPECT_EQ(facts.cut_count, 0u);
  EXPECT_EQ(FilesOf(path_, facts).size(), 5u);
  EXPECT_EQ(PackedStoresIn(folder_), std::vector<fs::path>{path_});
  ExpectHoldsAll();
}

// An image with more fronts than parts has the shortest together in part 0.
TEST_F(StorePartsTest, FrontsAreReadWithoutTheRest) {
  Write();
  const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  for (uint32_t i = 0; i < kImages; ++i) {
    const CodedImage expected = ImageWithFronts(i);
    const size_t most = std::min<size_t>(expected.front_ends.size(), 3);
    for (size_t left_out = 1; left_out <= 5; ++left_out) {
      const auto front = reader.ReadFront(codes[i], left_out);
      ASSERT_TRUE(front) << front.error().message;
      ASSERT_EQ(front->has_value(), i != 3 && i != 5);
      if (!front->has_value()) continue;
      EXPECT_EQ((*front)->left_out, std::min(left_out, most));
      EXPECT_EQ((*front)->code,
                expected.code.substr(
                    0, expected.front_ends.end()[-static_cast<ptrdiff_t>((*front)->left_out)]));
    }
  }
}

TEST_F(StorePartsTest, WithoutItsLastPartsItIsCoarser) {
  Write();
  for (size_t left = 3; left >= 1; --left) {
    fs::remove(Part(left));
    const PackedStoreFacts facts = ReadPackedStore(path_).value();
    EXPECT_EQ(facts.found_parts, left);
    EXPECT_EQ(facts.cut_count, 0u);
    const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    for (uint32_t i = 0; i < kImages; ++i) {
      const CodedImage expected = ImageWithFronts(i);
      const bool is_whole = i == 3 || i == 5;
      const size_t fronts = std::min<size_t>(expected.front_ends.size(), 3);
      ASSERT_EQ(codes[i].missing_parts, is_whole ? 0 : std::min(4 - left, fronts)) << i;
      EXPECT_EQ(reader.Read(codes[i]).has_value(), is_whole);
      if (is_whole) continue;
      const auto front = reader.ReadFront(codes[i], codes[i].missing_parts);
      ASSERT_TRUE(front && *front);
      EXPECT_TRUE(expected.code.starts_with((*front)->code));
    }
  }
  fs::remove(Part(0));
  EXPECT_NE(Fault().find("a-r0.lfs: this part of the packed store cannot be read: No such file"),
            std::string::npos);
}

// A file that was not copied to its end lacks the LF images that were added last.
TEST_F(StorePartsTest, AnIncompletePartLacksTheLastImages) {
  Write();
  const std::string last = *ReadFile(Part(3)), first = *ReadFile(Part(0));
  size_t fewest = 0;
  for (const size_t bytes : {last.size() - 1, last.size() / 2, kPartHeadBytes, size_t{10}}) {
    ASSERT_TRUE(WriteFileAtomically(Part(3), last.substr(0, bytes)));
    const PackedStoreFacts facts = ReadPackedStore(path_).value();
    EXPECT_EQ(facts.found_parts, 4u);
    EXPECT_GT(facts.cut_count, fewest);
    fewest = facts.cut_count;
    const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
    PackedCodeReader reader = PackedCodeReader::Open(path_).value();
    for (uint32_t i = 0; i < kImages; ++i) {
      EXPECT_LE(codes[i].missing_parts, 1);
      EXPECT_EQ(reader.Read(codes[i]).has_value(), codes[i].missing_parts == 0);
    }
    // Image 0 was added last.
    EXPECT_EQ(codes[0].missing_parts, 1);
    if (bytes == kPartHeadBytes) break;
  }
  EXPECT_EQ(fewest, kImages - 2);
  ASSERT_TRUE(WriteFileAtomically(Part(0), first.substr(0, kPartHeadBytes + 1)));
  EXPECT_EQ(ReadPackedStore(path_).value().cut_count, kImages);
}

TEST_F(StorePartsTest, PartsOfOtherStoresAreErrors) {
  Write();
  const std::string part = *ReadFile(Part(1));
  for (size_t n = 0; n < 4; ++n) fs::remove(Part(n));
  fs::remove(path_);
  Write();
  ASSERT_TRUE(WriteFileAtomically(Part(1), part));
  EXPECT_NE(Fault().find("a-r1.lfs: is not part 1 of the packed store"), std::string::npos);
  const auto of_part = ReadPackedStore(Part(2));
  ASSERT_FALSE(of_part);
  EXPECT_NE(of_part.error().message.find("a-r2.lfs: is a part of a packed store"),
            std::string::npos);
  // A new store does not replace a foreign file.
  const auto writer = PackedStoreWriter::Create(path_, field_, plan_);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().kind, ErrorKind::kUsage);
}

TEST_F(StorePartsTest, StoresOfOtherKindsReplaceIt) {
  Write();
  plan_.part_count = 2;
  Write();
  EXPECT_EQ(Files(), (std::vector<std::string>{"a-r0.lfs", "a-r1.lfs", "a.lfs"}));
  ExpectHoldsAll();
  plan_.part_count = 0;
  Write();
  EXPECT_EQ(Files(), std::vector<std::string>{"a.lfs"});
  ExpectHoldsAll();
  plan_.part_count = 4;
  Write();
  EXPECT_EQ(Files(), kAllFiles);
}

// Parts to which nothing was added are not kept.
TEST_F(StorePartsTest, StoresOfWholeImagesHaveOnePart) {
  PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
  for (const uint32_t i : {3, 5}) ASSERT_TRUE(writer.Add({i}, ImageWithFronts(i)));
  ASSERT_TRUE(writer.Finish());
  EXPECT_EQ(Files(), (std::vector<std::string>{"a-r0.lfs", "a.lfs"}));
  EXPECT_EQ(ReadPackedStore(path_).value().part_count, 1u);
  const std::vector<PackedCode> codes = FindCodes(path_, field_.image_names).value();
  PackedCodeReader reader = PackedCodeReader::Open(path_).value();
  for (const uint32_t i : {3, 5})
    EXPECT_EQ(reader.Read(codes[i]).value().code, ImageWithFronts(i).code);
}

TEST_F(StorePartsTest, AnUnfinishedStoreGoesOn) {
  {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    for (uint32_t i = 4; i < 8; ++i) ASSERT_TRUE(writer.Add({i}, ImageWithFronts(i)));
    ASSERT_TRUE(writer.Commit());
    ASSERT_TRUE(writer.Add({9}, ImageWithFronts(9)));  // not committed
  }
  // A part may have its final name already, if the writer was killed when it finished the store.
  fs::rename(Part(1).string() + ".unfinished", Part(1));
  PackedStoreWriter writer = PackedStoreWriter::Resume(path_, field_, plan_).value();
  for (uint32_t i = 0; i < kImages; ++i) {
    EXPECT_EQ(writer.Has({i}), i >= 4 && i < 8);
    if (!writer.Has({i})) {
      ASSERT_TRUE(writer.Add({i}, ImageWithFronts(i)));
    }
  }
  ASSERT_TRUE(writer.Finish());
  EXPECT_EQ(Files(), kAllFiles);
  ExpectHoldsAll();
}

TEST_F(StorePartsTest, ALostPartOfAnUnfinishedStoreIsAnError) {
  {
    PackedStoreWriter writer = PackedStoreWriter::Create(path_, field_, plan_).value();
    ASSERT_TRUE(writer.Add({1}, ImageWithFronts(1)));
    ASSERT_TRUE(writer.Commit());
  }
  fs::remove(Part(2).string() + ".unfinished");
  const auto writer = PackedStoreWriter::Resume(path_, field_, plan_);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("a-r2.lfs.unfinished"), std::string::npos);
  FileLock lock = PackedStoreWriter::Lock(path_).value();
  PackedStoreWriter::RemoveUnfinished(path_, lock);
  lock.Remove();
  EXPECT_TRUE(Files().empty());
}

}  // namespace
}  // namespace lf
