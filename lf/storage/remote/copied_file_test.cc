// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/copied_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/storage/remote/test_web_server.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr RemoteOptions kShortTimes = {
    .connect_s = 2, .stall_s = 1, .most_attempts = 2, .first_wait_s = 0.01, .total_s = 20};

std::string CopiedContent() {
  std::string bytes(100'000, '\0');
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7 + i / 251 + 1);
  return bytes;
}

class CopiedFileTest : public ::testing::Test {
 protected:
  CopiedFileTest() {
    std::string name = (fs::temp_directory_path() / "lf_copied_file_XXXXXX").string();
    LF_CHECK(::mkdtemp(name.data()) != nullptr);
    folder_ = name;
  }
  ~CopiedFileTest() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  fs::path File() const { return folder_ / "file"; }
  CopiedFile Open(const std::optional<std::string>& url = std::nullopt) const {
    Result<CopiedFile> file = CopiedFile::Open(File(), url, kShortTimes);
    LF_CHECK(file.has_value());
    return *std::move(file);
  }
  RangeState Read(CopiedFile* file, uint64_t begin, uint64_t count) {
    bytes_ = "before ";
    const Result<RangeState> range = file->Read(
        begin, count, HashBytes(std::string_view(content_).substr(begin, count)), &bytes_);
    LF_CHECK(range.has_value());
    if (*range == RangeState::kRead) {
      EXPECT_EQ(bytes_, "before " + content_.substr(begin, count));
    } else {
      EXPECT_EQ(bytes_, "before ");
    }
    return *range;
  }

  const std::string content_ = CopiedContent();
  fs::path folder_;
  std::string bytes_;
};

TEST_F(CopiedFileTest, ReadsALocalFile) {
  std::ofstream(File()) << content_;
  CopiedFile file = Open();
  EXPECT_EQ(Read(&file, 0, 100'000), RangeState::kRead);
  EXPECT_EQ(Read(&file, 99'999, 1), RangeState::kRead);
  EXPECT_EQ(*file.Read(5, 0, HashBytes(""), &bytes_), RangeState::kRead);
  EXPECT_EQ(file.local_bytes(), 100'000u);
}

TEST_F(CopiedFileTest, TellsMissingBytesFromDamage) {
  EXPECT_FALSE(CopiedFile::Open(File(), std::nullopt).has_value());
  std::string damaged = content_.substr(0, 50'000);
  damaged[100] ^= 1;
  damaged.replace(20'000, 1000, std::string(1000, '\0'));
  std::ofstream(File()) << damaged;
  CopiedFile file = Open();
  EXPECT_EQ(Read(&file, 0, 1000), RangeState::kDamaged);
  EXPECT_NE(file.Complaint().find("file: is damaged: a wrong checksum in the bytes 0 to 1000"),
            std::string::npos);
  EXPECT_EQ(Read(&file, 20'100, 500), RangeState::kNotThere);
  EXPECT_NE(file.Complaint().find("never copied"), std::string::npos);
  EXPECT_EQ(Read(&file, 49'999, 2), RangeState::kNotThere);
  EXPECT_NE(file.Complaint().find("has 50000 bytes"), std::string::npos);
}

TEST_F(CopiedFileTest, RefusesHugeRanges) {
  std::ofstream(File()) << content_;
  CopiedFile file = Open();
  EXPECT_FALSE(file.Read(UINT64_MAX, 1, 0, &bytes_).has_value());
  EXPECT_FALSE(file.Read(0, UINT64_MAX, 0, &bytes_).has_value());
  EXPECT_EQ(*file.Read(uint64_t{1} << 62, uint64_t{1} << 32, 0, &bytes_), RangeState::kNotThere);
  EXPECT_EQ(bytes_.capacity(), std::string().capacity());
}

TEST_F(CopiedFileTest, FetchesEachRangeOnce) {
  const TestWebServer server([&](TestRequest request) { request.Answer(content_); });
  {
    CopiedFile file = Open(server.Url());
    EXPECT_EQ(Read(&file, 60'000, 5000), RangeState::kRead);
    EXPECT_EQ(Read(&file, 1000, 500), RangeState::kRead);
    EXPECT_EQ(Read(&file, 60'000, 5000), RangeState::kRead);
  }
  CopiedFile again = Open(server.Url());
  EXPECT_EQ(Read(&again, 1000, 500), RangeState::kRead);
  EXPECT_EQ(server.request_count(), 2);
  // Without the server, what was read is an incomplete local file.
  CopiedFile local = Open();
  EXPECT_EQ(Read(&local, 60'000, 5000), RangeState::kRead);
  EXPECT_EQ(Read(&local, 30'000, 5000), RangeState::kNotThere);
}

TEST_F(CopiedFileTest, FetchesADamagedRangeAgain) {
  const TestWebServer server([&](TestRequest request) {
    std::string sent = content_;
    if (request.number == 0) sent[2000] ^= 1;
    request.Answer(sent);
  });
  std::ofstream(File()) << std::string(100'000, 'x');
  CopiedFile file = Open(server.Url());
  EXPECT_EQ(Read(&file, 1500, 1000), RangeState::kRead);
  EXPECT_EQ(server.request_count(), 2);
}

TEST_F(CopiedFileTest, DoesNotKeepDamagedBytes) {
  const TestWebServer server(
      [&](TestRequest request) { request.Answer(std::string(100'000, 'x')); });
  CopiedFile file = Open(server.Url());
  EXPECT_EQ(Read(&file, 0, 1000), RangeState::kDamaged);
  EXPECT_NE(file.Complaint().find("/field.lfs: is damaged on the server"), std::string::npos);
  EXPECT_EQ(file.local_bytes(), 0u);
}

TEST_F(CopiedFileTest, SaysThatAFileOnTheServerEndsOrIsMissing) {
  const TestWebServer server([&](TestRequest request) {
    request.text.starts_with("GET /field.lfs") ? request.Answer(content_.substr(0, 500))
                                               : request.AnswerStatus("404 Not Found");
  });
  CopiedFile file = Open(server.Url());
  EXPECT_EQ(Read(&file, 400, 200), RangeState::kNotThere);
  EXPECT_EQ(Read(&file, 4000, 200), RangeState::kNotThere);
  EXPECT_EQ(Read(&file, 400, 100), RangeState::kRead);
  CopiedFile missing = Open(server.Url("/other.lfs"));
  EXPECT_EQ(Read(&missing, 0, 10), RangeState::kNotThere);
  EXPECT_NE(missing.Complaint().find("status 404"), std::string::npos);
}

TEST_F(CopiedFileTest, ReadsWithoutKeepingIfNothingCanBeWritten) {
  const TestWebServer server([&](TestRequest request) { request.Answer(content_); });
  fs::create_directory(File());
  CopiedFile file = Open(server.Url());
  EXPECT_EQ(Read(&file, 0, 1000), RangeState::kRead);
  EXPECT_EQ(Read(&file, 0, 1000), RangeState::kRead);
  EXPECT_EQ(server.request_count(), 2);
}

}  // namespace
}  // namespace lf
