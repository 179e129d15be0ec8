// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/ray_map_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/rebinning/ray_map_format.h"
#include "lf/rebinning/test_ray_map.h"

namespace lf {
namespace {

namespace fs = std::filesystem;
using ray_map_format::Head;
using ray_map_format::ShardHead;

const PlateEntries kEntries = {{"scene", "a field of light"}, {"images_done", "128"}};
constexpr size_t kManyCells = 10000;  // max_cells of maps, which allocate memory for all of them

class RayMapFile : public ::testing::Test {
 protected:
  RayMapFile() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("lf_ray_map_file_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(folder_);
  }
  ~RayMapFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string FileOf(const RayMap& map, int threads = 2) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "a.rays";
    EXPECT_TRUE(WriteRays(path, kEntries, map, pool));
    return *ReadFile(path);
  }
  // Writes the map to a file and returns the map that is read from it.
  RayMap Again(const RayMap& map, size_t max_cells, int threads) {
    ThreadPool pool(threads);
    const fs::path path = folder_ / "again.rays";
    EXPECT_TRUE(WriteRays(path, kEntries, map, pool));
    Result<RaysFile> read = ReadRays(path, max_cells, pool);
    EXPECT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->entries, kEntries);
    return std::move(read->map);
  }

  fs::path folder_;
};

RayMap MapOf(const std::vector<BinnedRay>& rays) {
  RayMap map(kManyCells);
  AddAll(rays, &map);
  return map;
}

void ExpectSame(const RayMap& a, const RayMap& b) {
  ThreadPool pool(2);
  EXPECT_EQ(a.Cells(pool), b.Cells(pool));
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(a.limit(), b.limit());
  EXPECT_EQ(a.is_too_coarse(), b.is_too_coarse());
}

// Returns the message of the error that reading these bytes returns; empty if there is none.
std::string ErrorOf(const std::string& bytes, size_t max_cells = kManyCells) {
  ThreadPool pool(2);
  const Result<RaysFile> read = ReadRaysOfBytes(bytes, "a.rays", max_cells, pool);
  if (read) return "";
  EXPECT_EQ(read.error().kind, ErrorKind::kInput);
  return read.error().message;
}

void ExpectError(const std::string& bytes, const std::string& word) {
  const std::string message = ErrorOf(bytes);
  EXPECT_EQ(message.find("a.rays: "), 0u) << message;
  EXPECT_NE(message.find(word), std::string::npos) << message;
}

// Returns the bytes with a changed head and a correct checksum.
std::string WithHead(std::string bytes, const std::function<void(Head*)>& change) {
  Head head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  const size_t front_bytes = sizeof(head) + head.text_bytes;
  change(&head);
  std::memcpy(bytes.data(), &head, sizeof(head));
  const uint64_t hash = HashBytes(std::string_view(bytes).substr(0, front_bytes));
  std::memcpy(bytes.data() + front_bytes, &hash, sizeof(hash));
  return bytes;
}

// Returns the bytes of a file with these cells, all in one shard, and with correct checksums.
std::string FileOfCells(const std::vector<BinnedCell>& cells, size_t shard,
                        uint64_t limit = UINT64_MAX) {
  Head head = {};
  head.shard_count = RayMap::kShards;
  head.limit = limit;
  head.cell_count = cells.size();
  std::string bytes = entry_file::FrontOf(ray_map_format::kKind,
                                          {reinterpret_cast<const char*>(&head), sizeof(head)}, {});
  for (size_t i = 0; i < RayMap::kShards; ++i) {
    std::string of_shard;
    if (i == shard && !cells.empty())
      of_shard.assign(reinterpret_cast<const char*>(cells.data()),
                      cells.size() * sizeof(BinnedCell));
    const ShardHead shard_head = {of_shard.size() / sizeof(BinnedCell), HashBytes(of_shard, i)};
    bytes.append(reinterpret_cast<const char*>(&shard_head), sizeof(shard_head)) += of_shard;
  }
  return bytes;
}

// Returns the first keys of a shard.
std::vector<CellKey> KeysOf(size_t shard, size_t count) {
  std::vector<CellKey> keys;
  for (CellKey key = 1; keys.size() < count; ++key)
    if (RayMap::ShardOf(key) == shard) keys.push_back(key);
  return keys;
}

TEST_F(RayMapFile, GoesOnAsTheMapThatWasWritten) {
  for (const size_t max_cells : {1, 40, 5000, 30000, 100000}) {
    for (const int threads : {1, 2, 3}) {
      ThreadPool pool(threads);
      RayMap whole(max_cells), stopped(max_cells);
      for (uint64_t batch = 0; batch < 8; ++batch) {
        // First the keys of the rays repeat, then they are all over the range. `others` are added
        // only to existing cells.
        for (const uint64_t cells : {uint64_t{20000}, UINT64_MAX}) {
          const std::vector<BinnedRay> rays = RandomRays(5000, cells, 2 * batch + cells % 2);
          const std::vector<BinnedRay> others = RandomRays(2000, cells, 100 + batch);
          for (RayMap* map : {&whole, &stopped}) {
            AddAll(rays, map);
            map->Trim(pool);
            for (const BinnedRay& ray : others)
              map->AddToThoseThere(RayMap::ShardOf(ray.cell), std::span(&ray, 1));
          }
        }
        stopped = Again(stopped, max_cells, threads);
        ExpectSame(stopped, whole);
      }
      EXPECT_LE(whole.size(), max_cells);
      EXPECT_EQ(whole.limit() < UINT64_MAX, max_cells < 100000);
      EXPECT_EQ(FileOf(stopped), FileOf(whole));
    }
  }
}

TEST_F(RayMapFile, TheBytesDependOnTheRaysAlone) {
  std::vector<BinnedRay> rays = RandomRays(20000, 9000, 1);
  const std::string bytes = FileOf(MapOf(rays), 1);
  EXPECT_EQ(FileOf(MapOf(rays), 3), bytes);
  std::reverse(rays.begin(), rays.end());
  EXPECT_EQ(FileOf(MapOf(rays), 7), bytes);
  // This map has to grow.
  RayMap small(10);
  AddAll(rays, &small);
  EXPECT_EQ(FileOf(small), bytes);
  rays[5].rgb[1] ^= 1;
  EXPECT_NE(FileOf(MapOf(rays)), bytes);
}

TEST_F(RayMapFile, ManyCellsOfOneShardAreThereAgain) {
  RayMap map(5000);
  const std::vector<CellKey> keys = KeysOf(3, 5000);
  for (const CellKey key : keys) AddAll({{key, {1, 2, 3}}}, &map);
  const RayMap read = Again(map, 5000, 2);
  ExpectSame(read, map);
  EXPECT_EQ(read.size_bytes(), map.size_bytes());
}

TEST_F(RayMapFile, KeepsThatCellsOverflowed) {
  RayMap map(10);
  AddAll(std::vector<BinnedRay>(BinnedCell::kMostRays, {7, {65535, 65535, 0}}), &map);
  EXPECT_FALSE(Again(map, 10, 1).is_too_coarse());
  AddAll({{7, {1, 1, 1}}}, &map);
  RayMap read = Again(map, 10, 1);
  EXPECT_TRUE(read.is_too_coarse());
  ExpectSame(read, map);
  ExpectSame(Again(read, 10, 1), map);
}

TEST_F(RayMapFile, AMapOfNothingIsAFileToo) {
  const RayMap map(10);
  ExpectSame(Again(map, 10, 2), map);
  EXPECT_EQ(FileOfCells({}, 0).size(), 560u);  // the example of doc/formats/rays.md
}

TEST_F(RayMapFile, MoreCellsThanAllowedAreRefused) {
  const RayMap map = MapOf(RandomRays(100, UINT64_MAX, 1));
  const std::string bytes = FileOf(map);
  EXPECT_EQ(ErrorOf(bytes, 100), "");
  const std::string message = ErrorOf(bytes, 99);
  EXPECT_NE(message.find("a.rays: contains 100 cells, but {max_rays} and {memory} allow only 99"),
            std::string::npos)
      << message;
}

TEST_F(RayMapFile, TruncatedAnywhereItIsRefused) {
  const std::string bytes = FileOf(MapOf(RandomRays(100, UINT64_MAX, 1)));
  EXPECT_EQ(ErrorOf(bytes), "");
  for (size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 97)
    ExpectError(bytes.substr(0, size), size < 40 ? "is not a file of rays" : "is truncated");
  ExpectError(bytes.substr(0, bytes.size() - 1), "is truncated");
  ExpectError(bytes + "x", "1 bytes follow its end");
}

TEST_F(RayMapFile, ABitFlippedAnywhereIsSeen) {
  const std::string bytes = FileOf(MapOf(RandomRays(50, UINT64_MAX, 1)));
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    EXPECT_NE(ErrorOf(damaged), "") << i;
  }
}

TEST_F(RayMapFile, WhatItSaysIsCheckedBeforeAnythingIsAllocated) {
  const std::string bytes = FileOf(MapOf(RandomRays(50, UINT64_MAX, 1)));
  ExpectError(WithHead(bytes, [](Head* head) { head->version = 7; }), "version 7");
  ExpectError(WithHead(bytes, [](Head* head) { head->shard_count = 16; }), "16 shards");
  ExpectError(WithHead(bytes, [](Head* head) { head->is_too_coarse = 2; }),
              "2 as the mark of cells that are too wide");
  ExpectError(WithHead(bytes, [](Head* head) { head->cell_count = 51; }), "51 cells need more");
  ExpectError(WithHead(bytes, [](Head* head) { head->cell_count = UINT64_MAX; }), "need more");
  ExpectError(WithHead(bytes, [](Head* head) { head->cell_count = 49; }), "24 bytes follow");
  std::string long_text = bytes;
  const uint32_t text_bytes = 1u << 31;
  std::memcpy(long_text.data() + 12, &text_bytes, sizeof(text_bytes));
  ExpectError(long_text, "bytes of text");
  ExpectError("no rays at all, but long enough to be some", "does not begin with \"LFCELLS\"");
}

TEST_F(RayMapFile, ShardsHoldAsManyCellsAsTheHeadSays) {
  const BinnedCell cell = {KeysOf(0, 1)[0], {1, 2, 3}, 1};
  const std::string bytes = FileOfCells({cell}, 0);
  EXPECT_EQ(ErrorOf(bytes), "");
  const auto with_count = [&](uint64_t count) {
    std::string other = bytes;
    std::memcpy(other.data() + sizeof(Head) + sizeof(uint64_t), &count, sizeof(count));
    return other;
  };
  ExpectError(with_count(2), "shard 0: 2 cells, at most 1 were expected");
  ExpectError(with_count(UINT64_MAX), "at most 1 were expected");
  ExpectError(with_count(0), "is damaged");
  // The file is long enough for one cell, but no shard has one.
  std::string lacking = FileOfCells({}, 0) + std::string(sizeof(BinnedCell), '\0');
  ExpectError(WithHead(lacking, [](Head* head) { head->cell_count = 1; }), "lack 1 of 1 cells");
}

TEST_F(RayMapFile, CellsThatNoMapHoldsAreRefused) {
  const std::vector<CellKey> keys = KeysOf(5, 3);
  const BinnedCell a = {keys[0], {65535, 2, 3}, 1}, b = {keys[1], {UINT32_MAX, 0, 1}, 65537};
  EXPECT_EQ(ErrorOf(FileOfCells({a, b}, 5)), "");
  ExpectError(FileOfCells({b, a}, 5), "keys must ascend");
  ExpectError(FileOfCells({a, a}, 5), "keys must ascend");
  ExpectError(FileOfCells({a, b}, 6), "belongs to shard 5");
  ExpectError(FileOfCells({a}, 5, MixBits(a.cell)), "is not below the limit");
  EXPECT_EQ(ErrorOf(FileOfCells({a}, 5, MixBits(a.cell) + 1)), "");
  BinnedCell none = a;
  none.cell = 0;
  ExpectError(FileOfCells({none}, RayMap::ShardOf(0)), "keys must ascend");
  none = a;
  none.count = 0;
  ExpectError(FileOfCells({none}, 5), "0 rays, expected 1 to 65537");
  none.count = 65538;
  ExpectError(FileOfCells({none}, 5), "65538 rays");
  none = a;
  none.rgb[2] = 65536;
  ExpectError(FileOfCells({none}, 5), "a sum of 65536 is more than 1 rays");
}

TEST_F(RayMapFile, FilesThatAreNoneAreErrors) {
  ThreadPool pool(1);
  EXPECT_EQ(ReadRays(folder_ / "none", 10, pool).error().kind, ErrorKind::kInput);
  EXPECT_NE(ReadRays(folder_, 10, pool).error().message.find("expected a file"), std::string::npos);
  EXPECT_EQ(WriteRays(folder_ / "no" / "x", {}, RayMap(1), pool).error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
