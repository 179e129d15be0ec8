// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as a file of rebinned rays: this must fail with an error, or return a map that
// holds only cells that rays can make. The checksums of the head and of the shards are corrected
// first, because otherwise the code after their tests would never be reached.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/rebinning/ray_map_file.h"
#include "lf/rebinning/ray_map_format.h"

namespace {

void MakeChecksumsRight(std::string* bytes) {
  using namespace lf::ray_map_format;
  Head head;
  if (bytes->size() < sizeof(head)) return;
  std::memcpy(&head, bytes->data(), sizeof(head));
  size_t at = sizeof(head) + std::min<size_t>(head.text_bytes, bytes->size());
  const auto put = [&](size_t place, uint64_t hash) {
    if (place + sizeof(hash) <= bytes->size())
      std::memcpy(bytes->data() + place, &hash, sizeof(hash));
  };
  if (at > bytes->size()) return;
  put(at, lf::HashBytes(std::string_view(*bytes).substr(0, at)));
  at += sizeof(uint64_t);
  for (size_t i = 0; i < lf::RayMap::kShards && at + sizeof(ShardHead) <= bytes->size(); ++i) {
    ShardHead shard;
    std::memcpy(&shard, bytes->data() + at, sizeof(shard));
    at += sizeof(shard);
    if (shard.cell_count > (bytes->size() - at) / sizeof(lf::BinnedCell)) return;
    const size_t size = shard.cell_count * sizeof(lf::BinnedCell);
    put(at - sizeof(uint64_t), lf::HashBytes(std::string_view(*bytes).substr(at, size), i));
    at += size;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  constexpr size_t kMaxCells = 100;
  static lf::ThreadPool* const pool = new lf::ThreadPool(1);
  std::string bytes(reinterpret_cast<const char*>(data), size_bytes);
  MakeChecksumsRight(&bytes);
  const lf::Result<lf::RaysFile> read = lf::ReadRaysOfBytes(bytes, "r", kMaxCells, *pool);
  if (!read) {
    LF_CHECK(read.error().message.starts_with("r: "));
    return 0;
  }
  LF_CHECK(read->map.size() <= kMaxCells);
  const std::vector<lf::BinnedCell> cells = read->map.Cells(*pool);
  LF_CHECK(cells.size() == read->map.size());
  lf::CellKey last = 0;
  for (const lf::BinnedCell& cell : cells) {
    LF_CHECK(cell.cell > last && read->map.MayHold(cell.cell));
    LF_CHECK(cell.count >= 1 && cell.count <= lf::BinnedCell::kMostRays);
    for (int c = 0; c < 3; ++c) LF_CHECK(cell.Mean(c) <= 65535);
    last = cell.cell;
  }
  return 0;
}
