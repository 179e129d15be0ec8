// SPDX-License-Identifier: Apache-2.0
// Files of plates that have the gaps of their lenses.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/plate_format.h"
#include "lf/film/plate/test_plate.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

const PlateEntries kGapEntries = {{"mode", "hybrid"}};

class PlateGapsFile : public ::testing::Test {
 protected:
  PlateGapsFile() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("lf_plate_gaps_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(folder_);
  }
  ~PlateGapsFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string BytesOf(const SensorPlate& plate, const PlateGaps* gaps, int threads = 2) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "x.plate";
    EXPECT_TRUE(WritePlate(path, kGapEntries, plate, pool, gaps));
    return *ReadFile(path);
  }

  fs::path folder_;
};

// Returns gaps with shares from 0 to 1.
PlateGaps NoiseGaps(PlateKind kind, int width, int height, uint64_t seed) {
  PlateGaps gaps = {testing::NoisePlateOf(plate_format::GapKindOf(kind), width, height, seed),
                    Image<float>(width, height)};
  gaps.rays.Add(width - 1, height - 1, 2, {uint64_t{40000} << 24, uint64_t{1} << 24});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      gaps.share.at(x, y) = static_cast<float>((7 * x + 3 * y) % 11) / 10;
  return gaps;
}

// Reads a file to its end. Returns the message of the error; empty if there is none.
std::string ReadAll(const std::string& bytes, SensorPlate* plate, PlateGaps* gaps) {
  Result<PlateReader> reader = PlateReader::OpenBytes(bytes, "x.plate");
  if (!reader) return reader.error().message;
  if (plate->width() == 0) *plate = SensorPlate(reader->width(), reader->height(), reader->kind());
  Result<void> added = reader->AddTo(plate);
  if (added && reader->has_gaps()) added = reader->AddGapsTo(gaps);
  return added ? "" : added.error().message;
}

std::string GapsErrorOf(const std::string& bytes) {
  SensorPlate plate(0, 0);
  PlateGaps gaps;
  return ReadAll(bytes, &plate, &gaps);
}

TEST_F(PlateGapsFile, GivesBackTheirRaysAndShares) {
  for (const PlateKind kind : {PlateKind::kColours, PlateKind::kOpacity, PlateKind::kGuarded,
                               PlateKind::kGuardedOpacity}) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(317, 211)}) {
      const SensorPlate plate = testing::NoisePlateOf(kind, width, height, 7);
      const PlateGaps gaps = NoiseGaps(kind, width, height, 8);
      SensorPlate read(0, 0);
      PlateGaps read_gaps;
      ASSERT_EQ(ReadAll(BytesOf(plate, &gaps), &read, &read_gaps), "");
      EXPECT_EQ(read, plate);
      EXPECT_EQ(read_gaps.rays, gaps.rays);
      EXPECT_EQ(read_gaps.share.pixels(), gaps.share.pixels());
    }
  }
}

TEST_F(PlateGapsFile, TheRaysOfShardsAdd) {
  const PlateKind kind = PlateKind::kColours;
  SensorPlate expected(50, 40), expected_rays(50, 40), sum(50, 40);
  PlateGaps gaps;
  for (const uint64_t seed : {1, 2, 3}) {
    const SensorPlate plate = testing::NoisePlateOf(kind, 50, 40, seed);
    const PlateGaps of_shard = NoiseGaps(kind, 50, 40, seed + 10);
    expected.Merge(plate);
    expected_rays.Merge(of_shard.rays);
    ASSERT_EQ(ReadAll(BytesOf(plate, &of_shard), &sum, &gaps), "");
    EXPECT_EQ(gaps.share.pixels(), of_shard.share.pixels());
  }
  EXPECT_EQ(sum, expected);
  EXPECT_EQ(gaps.rays, expected_rays);
}

TEST_F(PlateGapsFile, AnotherShareIsRefused) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kColours, 50, 40, 1);
  PlateGaps one = NoiseGaps(PlateKind::kColours, 50, 40, 2), sum;
  SensorPlate plate_sum(50, 40);
  ASSERT_EQ(ReadAll(BytesOf(plate, &one), &plate_sum, &sum), "");
  one.share.at(49, 39) = std::nextafter(one.share.at(49, 39), 0.5f);
  const std::string error = ReadAll(BytesOf(plate, &one), &plate_sum, &sum);
  EXPECT_EQ(error.find("x.plate: the gaps of its lens have a share of "), 0u) << error;
  EXPECT_NE(error.find("in element (49, 39)"), std::string::npos) << error;
  PlateGaps small = NoiseGaps(PlateKind::kColours, 30, 40, 2);
  SensorPlate small_plate(0, 0);
  const std::string size_error = ReadAll(
      BytesOf(testing::NoisePlateOf(PlateKind::kColours, 30, 40, 1), &small), &small_plate, &sum);
  EXPECT_NE(size_error.find("30 x 40 elements, expected 50 x 40"), std::string::npos) << size_error;
}

TEST_F(PlateGapsFile, APlateWithoutGapsKeepsItsVersionAndBytes) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kColours, 60, 40, 7);
  const PlateGaps gaps = NoiseGaps(PlateKind::kColours, 60, 40, 8);
  const std::string without = BytesOf(plate, nullptr), with = BytesOf(plate, &gaps);
  plate_format::Head head;
  std::memcpy(&head, without.data(), sizeof(head));
  EXPECT_EQ(head.version, 3u);
  const size_t front_bytes = sizeof(head) + head.text_bytes + sizeof(uint64_t);
  std::memcpy(&head, with.data(), sizeof(head));
  EXPECT_EQ(head.version, 4u);
  ASSERT_GT(with.size(), without.size());
  EXPECT_EQ(with.substr(front_bytes, without.size() - front_bytes), without.substr(front_bytes));
  EXPECT_FALSE(PlateReader::OpenBytes(without, "x")->has_gaps());
  // A reader that does not ask for the gaps gets the plate.
  SensorPlate read(60, 40);
  ASSERT_TRUE(PlateReader::OpenBytes(with, "x")->AddTo(&read));
  EXPECT_EQ(read, plate);
}

TEST_F(PlateGapsFile, TheBytesDependNeitherOnThreadsNorOnStorage) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kOpacity, 300, 200, 7);
  const PlateGaps gaps = NoiseGaps(PlateKind::kOpacity, 300, 200, 8);
  EXPECT_EQ(BytesOf(plate, &gaps, 3), BytesOf(plate, &gaps, 1));
}

TEST_F(PlateGapsFile, TruncatedOrChangedAnywhereItIsRefused) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kColours, 20, 15, 7);
  const PlateGaps gaps = NoiseGaps(PlateKind::kColours, 20, 15, 8);
  const std::string bytes = BytesOf(plate, &gaps);
  ASSERT_EQ(GapsErrorOf(bytes), "");
  for (size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 7)
    EXPECT_NE(GapsErrorOf(bytes.substr(0, size)), "") << size;
  EXPECT_NE(GapsErrorOf(bytes.substr(0, bytes.size() - 1)), "");
  EXPECT_NE(GapsErrorOf(bytes + "x").find("1 bytes follow its end"), std::string::npos);
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    EXPECT_NE(GapsErrorOf(damaged), "") << i;
  }
}

TEST_F(PlateGapsFile, OnlySharesFrom0To1AreRead) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kColours, 20, 15, 7);
  for (const float wrong : {-0.001f, 1.001f, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
    PlateGaps gaps = NoiseGaps(PlateKind::kColours, 20, 15, 8);
    gaps.share.at(3, 14) = wrong;
    const std::string error = GapsErrorOf(BytesOf(plate, &gaps));
    EXPECT_NE(error.find("row 14: "), std::string::npos) << error;
    EXPECT_NE(error.find("is no share of a gap"), std::string::npos) << error;
  }
}

TEST_F(PlateGapsFile, ManyWideWordsAndLargePlatesAreRefusedWithoutMemory) {
  const SensorPlate plate = testing::NoisePlateOf(PlateKind::kColours, 20, 15, 7);
  const PlateGaps gaps = NoiseGaps(PlateKind::kColours, 20, 15, 8);
  const std::string bytes = BytesOf(plate, &gaps), without = BytesOf(plate, nullptr);
  std::string many = bytes;
  plate_format::GapHead head = {uint64_t{1} << 60, 0};
  head.hash = HashBytes({reinterpret_cast<const char*>(&head.wide_count), sizeof(uint64_t)});
  std::memcpy(many.data() + without.size(), &head, sizeof(head));
  EXPECT_NE(GapsErrorOf(many).find("is truncated"), std::string::npos) << GapsErrorOf(many);
  head.hash ^= 1;
  std::memcpy(many.data() + without.size(), &head, sizeof(head));
  EXPECT_NE(GapsErrorOf(many).find("the head of its gaps"), std::string::npos);
  // A head that promises gaps needs room for all three kinds of chunks.
  std::string short_file = without;
  plate_format::Head front;
  std::memcpy(&front, short_file.data(), sizeof(front));
  const size_t front_bytes = sizeof(front) + front.text_bytes;
  front.version = plate_format::kVersionWithGaps;
  front.rows_per_chunk = 1;
  front.height = static_cast<uint32_t>(without.size() / (2 * sizeof(plate_format::ChunkHead)));
  std::memcpy(short_file.data(), &front, sizeof(front));
  const uint64_t hash = HashBytes(std::string_view(short_file).substr(0, front_bytes));
  std::memcpy(short_file.data() + front_bytes, &hash, sizeof(hash));
  const Result<PlateReader> opened = PlateReader::OpenBytes(short_file, "x.plate");
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("is truncated"), std::string::npos);
}

}  // namespace
}  // namespace lf
