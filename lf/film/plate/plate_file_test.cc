// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/plate_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/film/plate/plate_format.h"
#include "lf/film/plate/test_plate.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

const PlateEntries kEntries = {{"estimator", "nearest"}, {"ranks_done", "128"}, {"empty", ""}};

class PlateFile : public ::testing::Test {
 protected:
  PlateFile() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("lf_plate_file_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(folder_);
  }
  ~PlateFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string BytesOf(const SensorPlate& plate, int threads = 2) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "x.plate";
    EXPECT_TRUE(WritePlate(path, kEntries, plate, pool));
    return *ReadFile(path);
  }

  fs::path folder_;
};

// Returns the message of the error when these bytes are read to the end; empty if there is none.
std::string ErrorOf(const std::string& bytes) {
  Result<PlateReader> reader = PlateReader::OpenBytes(bytes, "x.plate");
  if (!reader) return reader.error().message;
  SensorPlate plate(reader->width(), reader->height());
  const Result<void> added = reader->AddTo(&plate);
  return added ? "" : added.error().message;
}

void ExpectError(const std::string& bytes, const std::string& word) {
  const std::string message = ErrorOf(bytes);
  EXPECT_EQ(message.find("x.plate: "), 0u) << message;
  EXPECT_NE(message.find(word), std::string::npos) << message;
}

// Returns the bytes of a plate's file with a changed head, and with the checksum of the new head.
std::string WithHead(std::string bytes, const std::function<void(plate_format::Head*)>& change) {
  plate_format::Head head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  const size_t front_bytes = sizeof(head) + head.text_bytes;
  change(&head);
  std::memcpy(bytes.data(), &head, sizeof(head));
  const uint64_t hash = HashBytes(std::string_view(bytes).substr(0, front_bytes));
  std::memcpy(bytes.data() + front_bytes, &hash, sizeof(hash));
  return bytes;
}

TEST_F(PlateFile, GivesBackEverySumAndCount) {
  ThreadPool pool(2);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(317, 211), std::pair(30000, 3)}) {
    const SensorPlate plate = testing::NoisePlate(width, height, 7, SensorPlate::kMaxCount, true);
    const fs::path path = folder_ / "a.plate";
    ASSERT_TRUE(WritePlate(path, kEntries, plate, pool));
    Result<PlateReader> reader = PlateReader::Open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->entries(), kEntries);
    EXPECT_EQ(*FindEntry(reader->entries(), "ranks_done"), "128");
    EXPECT_EQ(FindEntry(reader->entries(), "places"), nullptr);
    ASSERT_EQ(reader->width(), width);
    ASSERT_EQ(reader->height(), height);
    SensorPlate read(width, height);
    ASSERT_TRUE(reader->AddTo(&read));
    EXPECT_EQ(read, plate);
  }
}

TEST_F(PlateFile, GivesBackAllChannelsOfEachKindWideWordsIncluded) {
  ThreadPool pool(2);
  for (const PlateKind kind : {PlateKind::kColours, PlateKind::kOpacity, PlateKind::kGuarded,
                               PlateKind::kGuardedOpacity}) {
    SensorPlate plate = testing::NoisePlateOf(kind, 317, 211, 7);
    plate.Add(316, 210, plate.channels() - 1, {uint64_t{61440} << 24, uint64_t{1} << 24});
    const fs::path path = folder_ / "a.plate";
    ASSERT_TRUE(WritePlate(path, kEntries, plate, pool));
    Result<PlateReader> reader = PlateReader::Open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    ASSERT_EQ(reader->kind(), kind);
    SensorPlate read(317, 211, kind);
    ASSERT_TRUE(reader->AddTo(&read));
    EXPECT_EQ(read, plate);
  }
}

TEST_F(PlateFile, ReadingEndsIfInterrupted) {
  ThreadPool pool(2);
  const fs::path path = folder_ / "a.plate";
  ASSERT_TRUE(WritePlate(path, kEntries,
                         testing::NoisePlate(317, 2000, 7, SensorPlate::kMaxCount, true), pool));
  int asked = 0;
  SensorPlate whole(317, 2000);
  ASSERT_TRUE(PlateReader::Open(path)->AddTo(&whole, [&] { return ++asked < 0; }));
  EXPECT_GT(asked, 3);
  for (const int moment : {1, 2, asked / 2, asked}) {
    int now = 0;
    SensorPlate part(317, 2000);
    const Result<void> added =
        PlateReader::Open(path)->AddTo(&part, [&] { return ++now >= moment; });
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().kind, ErrorKind::kInterrupted);
    EXPECT_EQ(now, moment);
  }
}

// If an element gets more rays than a packed word can hold, they move to the wide table, and later
// rays are packed again.
TEST_F(PlateFile, KeepsTheRaysThatAWideElementGetsLater) {
  constexpr uint64_t kMost = SensorPlate::kMaxCount;
  for (const uint32_t count_limit : {SensorPlate::kMaxCount, 10u}) {
    SensorPlate plate(7, 5, count_limit);
    plate.Add(6, 3, 1, {1000 * (kMost + 1), kMost + 1});
    plate.Add(6, 3, 1, {2 * 30000, 2});
    plate.Add(0, 4, 2, {7 * kMost, kMost});  // together, these two fit no packed word
    plate.Add(0, 4, 2, {5 * 9, 5});
    SensorPlate read(7, 5);
    const std::string bytes = BytesOf(plate);
    ASSERT_TRUE(PlateReader::OpenBytes(bytes, "x")->AddTo(&read));
    EXPECT_EQ(read.At(6, 3, 1), (ElementSum{1000 * (kMost + 1) + 60000, kMost + 3}));
    EXPECT_EQ(read.At(0, 4, 2), (ElementSum{7 * kMost + 45, kMost + 5}));
    EXPECT_EQ(read.At(0, 4, 1), ElementSum{});
  }
}

TEST_F(PlateFile, AddsToWhatIsThere) {
  const SensorPlate a = testing::NoisePlate(50, 40, 1, SensorPlate::kMaxCount, true);
  const SensorPlate b = testing::NoisePlate(50, 40, 2, SensorPlate::kMaxCount, true);
  SensorPlate sum(50, 40), expected(50, 40);
  for (const SensorPlate* plate : {&a, &b}) {
    expected.Merge(*plate);
    const std::string bytes = BytesOf(*plate);
    ASSERT_TRUE(PlateReader::OpenBytes(bytes, "x")->AddTo(&sum));
  }
  EXPECT_EQ(sum, expected);
}

TEST_F(PlateFile, TheBytesDependOnTheRaysAlone) {
  const SensorPlate plate = testing::NoisePlate(300, 200, 7, SensorPlate::kMaxCount, true);
  const std::string bytes = BytesOf(plate, 1);
  EXPECT_EQ(BytesOf(plate, 3), bytes);
  // A plate with the same rays, most of them in the wide table.
  const SensorPlate small = testing::NoisePlate(300, 200, 7, 5, true);
  EXPECT_GT(small.wide().size(), 10000u);
  EXPECT_EQ(BytesOf(small), bytes);
  SensorPlate other = testing::NoisePlate(300, 200, 7, SensorPlate::kMaxCount, true);
  other.AddRay(10, 10, 0, 0);
  EXPECT_NE(BytesOf(other), bytes);
}

TEST_F(PlateFile, TruncatedAnywhereItIsRefused) {
  const std::string bytes = BytesOf(testing::NoisePlate(40, 30, 7, SensorPlate::kMaxCount, true));
  EXPECT_EQ(ErrorOf(bytes), "");
  for (size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 97)
    ExpectError(bytes.substr(0, size), size < 40 ? "is not a plate" : "is truncated");
  ExpectError(bytes.substr(0, bytes.size() - 1), "is truncated");
  ExpectError(bytes + "x", "1 bytes follow its end");
}

TEST_F(PlateFile, ABitFlippedAnywhereIsSeen) {
  const std::string bytes = BytesOf(testing::NoisePlate(20, 15, 7, SensorPlate::kMaxCount, true));
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    EXPECT_NE(ErrorOf(damaged), "") << i;
  }
}

TEST_F(PlateFile, WhatItSaysIsCheckedBeforeAnythingIsAllocated) {
  using plate_format::Head;
  const std::string bytes = BytesOf(testing::NoisePlate(20, 15, 7, SensorPlate::kMaxCount, true));
  ExpectError(WithHead(bytes, [](Head* head) { head->version = 7; }),
              "version 7, but this program reads versions 3 and 4: use the program that wrote it");
  ExpectError(WithHead(bytes, [](Head* head) { head->version = 2; }),
              "version 2, which builds of lfrendertools from before version 0.1.0 read, but");
  ExpectError(WithHead(bytes, [](Head* head) { head->width = 0; }), "0 x 15");
  ExpectError(WithHead(bytes, [](Head* head) { head->height = 65537; }),
              "width and height from 1 to 65536");
  ExpectError(WithHead(bytes, [](Head* head) { head->height = 65536, head->rows_per_chunk = 1; }),
              "20 x 65536");
  ExpectError(WithHead(bytes, [](Head* head) { head->width = 65536; }), "chunks of 1092 rows");
  ExpectError(WithHead(bytes, [](Head* head) { head->channels = 5; }), "5 channels");
  ExpectError(WithHead(bytes, [](Head* head) { head->channels = 7; }),
              "7 channels, expected 3, 4, 8 or 10 channels");
  ExpectError(WithHead(bytes, [](Head* head) { head->rows_per_chunk = 0; }), "chunks of 0 rows");
  ExpectError(WithHead(bytes, [](Head* head) { head->rows_per_chunk = 1u << 31; }), "rows");
  ExpectError(WithHead(bytes, [](Head* head) { head->wide_count = uint64_t{1} << 60; }),
              "large sums");
  std::string long_text = bytes;
  const uint32_t text_bytes = 1u << 31;
  std::memcpy(long_text.data() + 12, &text_bytes, sizeof(text_bytes));
  ExpectError(long_text, "bytes of text");
  ExpectError("no plate at all, but long enough to be one", "does not begin with");
}

TEST_F(PlateFile, WideWordsLieInThePlateAndAscend) {
  using plate_format::WideWord;
  // NoisePlate() has kWords wide words. The checksum behind them has kEnd bytes.
  constexpr size_t kWords = 2, kEnd = sizeof(uint64_t);
  const std::string bytes = BytesOf(testing::NoisePlate(20, 15, 7, SensorPlate::kMaxCount, true));
  const auto with_words = [&](const std::function<void(WideWord*)>& change) {
    std::string changed = bytes;
    char* const begin = changed.data() + changed.size() - kEnd - kWords * sizeof(WideWord);
    WideWord words[kWords];
    std::memcpy(words, begin, sizeof(words));
    change(words);
    std::memcpy(begin, words, sizeof(words));
    const uint64_t hash = HashBytes({begin, sizeof(words)});
    std::memcpy(begin + sizeof(words), &hash, sizeof(hash));
    return changed;
  };
  constexpr uint64_t kPlateWords = 20 * 15 * 3;
  EXPECT_EQ(ErrorOf(with_words([](WideWord*) {})), "");
  EXPECT_EQ(ErrorOf(with_words([](WideWord* words) { words[1].index = kPlateWords - 1; })), "");
  for (const uint64_t index : {kPlateWords, kPlateWords + 1, UINT64_MAX})
    ExpectError(with_words([&](WideWord* words) { words[1].index = index; }), "is invalid");
  ExpectError(with_words([](WideWord* words) { words[1].index = words[0].index; }), "is invalid");
  ExpectError(with_words([](WideWord* words) { words[0].count = SensorPlate::kMaxCount; }),
              "is invalid");
  ExpectError(with_words([](WideWord* words) { words[0].sum = 65535 * words[0].count + 1; }),
              "is invalid");
}

TEST_F(PlateFile, EntriesOfAnotherFormAreRefused) {
  const std::string bytes = BytesOf(SensorPlate(4, 4));
  for (const auto& [from, to] : {std::pair("estimator: ", "Estimator: "),
                                 {"mpty: ", "mpty  "},
                                 {"empty: ", "e\npty: "},
                                 {"ranks_done: 128", "estimator: 12345"}}) {
    std::string other = bytes;
    const size_t at = other.find(from);
    ASSERT_NE(at, std::string::npos);
    other.replace(at, std::strlen(from), to);
    ExpectError(WithHead(other, [](plate_format::Head*) {}), "or a key twice; the plate cannot");
  }
}

TEST_F(PlateFile, FilesThatAreNoneAreErrors) {
  EXPECT_EQ(PlateReader::Open(folder_ / "none").error().kind, ErrorKind::kInput);
  EXPECT_NE(PlateReader::Open(folder_).error().message.find("expected a file"), std::string::npos);
  ThreadPool pool(1);
  EXPECT_EQ(WritePlate(folder_ / "no" / "x", {}, SensorPlate(1, 1), pool).error().kind,
            ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
