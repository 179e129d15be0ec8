// SPDX-License-Identifier: Apache-2.0
// Tests stores by resolution on a web server: what is read of them, and what is left if the server
// lacks files or damages them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "lf/camera/testing_scenes.h"
#include "lf/core/file.h"
#include "lf/core/random.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/part_file.h"
#include "lf/storage/remote/store_cache.h"
#include "lf/storage/remote/test_web_server.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kServedImages = 6;

CodedImage ServedImage(uint32_t i) {
  CodedImage image;
  image.values = StoredValues::kUint8;
  image.rect = {0, 0, 60, 41};
  for (uint64_t k = 0; k < 2000; ++k) image.code += static_cast<char>(RandomBits(4, i, k));
  if (i == 2) image.mask = "the mask";
  image.front_ends = {100, 300 + i, 900};
  return image;
}

class RemotePartsTest : public ::testing::Test {
 protected:
  RemotePartsTest()
      : folder_(fs::temp_directory_path() /
                ("lf_remote_parts_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
    PackedStorePlan plan;
    for (uint32_t i = 0; i < kServedImages; ++i) {
      const testing::CameraPair pair = testing::RandomDistortedPair(i);
      field_.intrinsics.push_back(pair.lf_camera.intrinsics);
      field_.cameras.push_back({pair.lf_camera.cam_from_world, i, 1.0f});
      field_.image_names.push_back("image " + std::to_string(i) + ".png");
    }
    plan.whole = {kServedImages, "0123456789abcdef", "fedcba9876543210"};
    plan.codec = "lossless";
    plan.part_count = 4;
    const fs::path path = folder_ / "a.lfs";
    PackedStoreWriter writer = PackedStoreWriter::Create(path, field_, plan).value();
    for (uint32_t i = 0; i < kServedImages; ++i) LF_CHECK(writer.Add({i}, ServedImage(i)));
    LF_CHECK(writer.Finish());
    for (const auto& entry : fs::directory_iterator(folder_))
      files_["/" + entry.path().filename().string()] = *ReadFile(entry.path());
    LF_CHECK(files_.size() == 5);
  }
  ~RemotePartsTest() override { fs::remove_all(folder_); }

  void Answer(TestRequest request) {
    const std::lock_guard lock(mutex_);
    const size_t begin = request.text.find(' ') + 1;
    const std::string path = request.text.substr(begin, request.text.find(' ', begin) - begin);
    const auto file = files_.find(path);
    if (file == files_.end()) return request.AnswerStatus("404 Not Found");
    request.Answer(file->second);
  }
  fs::path Open(const TestWebServer& server) const {
    StoreCacheOptions options;
    options.folder = folder_ / "cache";
    options.remote = {.most_attempts = 2, .first_wait_s = 0.01};
    const Result<fs::path> path = OpenRemoteStore(server.Url("/a.lfs"), options);
    EXPECT_TRUE(path) << path.error().message;
    return *path;
  }
  // Returns the number of LF images that are read as they were written.
  size_t CountOfRead(const fs::path& path, std::string* fault = nullptr) const {
    const std::vector<PackedCode> codes = FindCodes(path, field_.image_names).value();
    PackedCodeReader reader = PackedCodeReader::Open(path).value();
    size_t count = 0;
    for (uint32_t i = 0; i < kServedImages; ++i) {
      const auto bytes = reader.Read(codes[i]);
      if (!bytes && fault != nullptr) *fault = bytes.error().message;
      if (!bytes) continue;
      EXPECT_EQ(bytes->code, ServedImage(i).code);
      EXPECT_EQ(bytes->mask, ServedImage(i).mask);
      ++count;
    }
    return count;
  }

  fs::path folder_;
  LightField field_;
  std::map<std::string, std::string> files_;
  std::mutex mutex_;
  TestWebServer server_{[this](TestRequest request) { Answer(std::move(request)); }};
};

TEST_F(RemotePartsTest, AllIsReadOnce) {
  const fs::path path = Open(server_);
  EXPECT_EQ(CountOfRead(path), kServedImages);
  // Size and bytes of the tables, the head of each part, four pieces of each image, and a mask.
  EXPECT_EQ(server_.request_count(), 2 + 4 + 4 * static_cast<int>(kServedImages) + 1);
  EXPECT_EQ(CountOfRead(path), kServedImages);
  server_.Stop();
  EXPECT_EQ(CountOfRead(path), kServedImages);
  // Without its URL, the copy is a local store.
  fs::remove(fs::path(path) += ".url");
  EXPECT_EQ(CountOfRead(path), kServedImages);
}

TEST_F(RemotePartsTest, FrontsAreReadWithoutTheRest) {
  const fs::path path = Open(server_);
  const std::vector<PackedCode> codes = FindCodes(path, field_.image_names).value();
  PackedCodeReader reader = PackedCodeReader::Open(path).value();
  const auto front = reader.ReadFront(codes[1], 3);
  ASSERT_TRUE(front && *front);
  EXPECT_EQ((*front)->code, ServedImage(1).code.substr(0, 100));
  EXPECT_EQ(server_.request_count(), 2 + 4 + 1);
  server_.Stop();
  fs::remove(fs::path(path) += ".url");
  std::string fault;
  EXPECT_EQ(CountOfRead(path, &fault), 0u);
}

TEST_F(RemotePartsTest, WithoutItsLastPartItIsCoarser) {
  files_.erase("/a-r3.lfs");
  const fs::path path = Open(server_);
  EXPECT_EQ(ReadPackedStore(path).value().found_parts, 3u);
  EXPECT_EQ(FindCodes(path, field_.image_names).value()[0].missing_parts, 1);
}

TEST_F(RemotePartsTest, WithoutItsFirstPartItIsRefused) {
  files_.erase("/a-r0.lfs");
  const auto facts = ReadPackedStore(Open(server_));
  ASSERT_FALSE(facts);
  EXPECT_NE(facts.error().message.find("/a-r0.lfs: is not on the server"), std::string::npos)
      << facts.error().message;
}

TEST_F(RemotePartsTest, APartOfAnotherStoreIsRefused) {
  files_["/a-r1.lfs"][50] ^= 1;
  const auto facts = ReadPackedStore(Open(server_));
  ASSERT_FALSE(facts);
  EXPECT_NE(facts.error().message.find("/a-r1.lfs: is not part 1"), std::string::npos)
      << facts.error().message;
}

TEST_F(RemotePartsTest, DamageAndTruncationCostTheirImages) {
  std::string& last = files_["/a-r3.lfs"];
  last.pop_back();
  last[kPartHeadBytes] ^= 1;
  std::string fault;
  EXPECT_EQ(CountOfRead(Open(server_), &fault), kServedImages - 2);
  EXPECT_NE(fault.find("/a-r3.lfs: "), std::string::npos) << fault;
}

TEST_F(RemotePartsTest, ADamagedCopyIsMended) {
  const fs::path path = Open(server_);
  EXPECT_EQ(CountOfRead(path), kServedImages);
  std::string copy = *ReadFile(PartPath(path, 2));
  copy[100] ^= 1;
  ASSERT_TRUE(WriteFileAtomically(PartPath(path, 2), copy));
  const int before = server_.request_count();
  EXPECT_EQ(CountOfRead(path), kServedImages);
  EXPECT_EQ(server_.request_count(), before + 1);
  EXPECT_EQ(*ReadFile(PartPath(path, 2)), files_["/a-r2.lfs"]);
}

}  // namespace
}  // namespace lf
