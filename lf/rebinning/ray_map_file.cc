// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/ray_map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/film/plate/entry_file.h"
#include "lf/rebinning/ray_map_format.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using namespace ray_map_format;

// Largest number of shards whose cells are in memory twice at a time: an eighth of all shards, for
// any number of threads.
constexpr size_t kMostTogether = RayMap::kShards / 8;
size_t Together(const ThreadPool& pool) {
  return std::min(kMostTogether, static_cast<size_t>(pool.thread_count()));
}

struct Part {
  ShardHead head = {};
  std::vector<BinnedCell> cells;
};

std::string_view BytesOf(std::span<const BinnedCell> cells) {
  return {reinterpret_cast<const char*>(cells.data()), cells.size_bytes()};
}

Result<void> Write(const fs::path& path, const PlateEntries& entries, const RayMap& map,
                   ThreadPool& pool) {
  Head head = {};
  head.shard_count = RayMap::kShards;
  head.is_too_coarse = map.is_too_coarse() ? 1 : 0;
  head.limit = map.limit();
  head.cell_count = map.size();
  entry_file::OutputFile file(path);
  file.Write(entry_file::FrontOf(
      kKind, std::string(reinterpret_cast<const char*>(&head), sizeof(head)), entries));
  for (size_t first = 0; first < RayMap::kShards; first += Together(pool)) {
    std::vector<Part> parts(std::min(Together(pool), RayMap::kShards - first));
    pool.ForEach(parts.size(), [&](size_t i) {
      parts[i].cells = map.CellsOf(first + i);
      parts[i].head = {parts[i].cells.size(), HashBytes(BytesOf(parts[i].cells), first + i)};
    });
    for (const Part& part : parts) {
      file.Write(&part.head, sizeof(part.head));
      file.Write(BytesOf(part.cells));
    }
  }
  return file.Close();
}

// Returns the first fault of the cells of a shard; empty if there is none.
std::string FaultOf(const Part& part, size_t shard, const RayMap& map) {
  if (HashBytes(BytesOf(part.cells), shard) != part.head.hash)
    return fmt::format("the checksum of shard {} differs", shard);
  CellKey last = 0;
  for (const BinnedCell& cell : part.cells) {
    const auto fault = [&](const std::string& what) {
      return fmt::format("shard {}, cell {:016x}: {}", shard, cell.cell, what);
    };
    // Ascending keys are neither 0 nor repeated.
    if (cell.cell <= last)
      return fault(fmt::format("follows cell {:016x}, but keys must ascend", last));
    if (RayMap::ShardOf(cell.cell) != shard)
      return fault(fmt::format("belongs to shard {}", RayMap::ShardOf(cell.cell)));
    if (!map.MayHold(cell.cell))
      return fault(fmt::format("its hash {:016x} is not below the limit {:016x}",
                               MixBits(cell.cell), map.limit()));
    if (cell.count < 1 || cell.count > BinnedCell::kMostRays)
      return fault(fmt::format("{} rays, expected 1 to {}", cell.count, BinnedCell::kMostRays));
    for (const uint32_t sum : cell.rgb)
      if (sum > uint64_t{65535} * cell.count)
        return fault(fmt::format("a sum of {} is more than {} rays can have", sum, cell.count));
    last = cell.cell;
  }
  return {};
}

// Returns the head in `bytes`. Checks, before memory is allocated, that `source` has as many bytes
// left as the head says, and at most max_cells cells.
Result<Head> ReadHead(const entry_file::Source& source, const std::string& bytes,
                      size_t max_cells) {
  Head head;
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (head.shard_count != RayMap::kShards || head.is_too_coarse > 1)
    return InputError(fmt::format(
        "{}: is damaged: it states {} shards, expected {}, and {} as the mark of cells that "
        "are too wide, expected 0 or 1; the rays in the file cannot be used",
        source.name(), head.shard_count, RayMap::kShards, head.is_too_coarse));
  constexpr uint64_t kLeast = RayMap::kShards * sizeof(ShardHead);
  if (source.left() < kLeast || head.cell_count > (source.left() - kLeast) / sizeof(BinnedCell))
    return InputError(
        fmt::format("{}: is truncated: {} bytes follow its head, but {} cells need more; {}",
                    source.name(), source.left(), head.cell_count, kKind.if_broken));
  const uint64_t size_bytes = kLeast + head.cell_count * sizeof(BinnedCell);
  if (source.left() > size_bytes)
    return source.Damaged(fmt::format("{} bytes follow its end", source.left() - size_bytes));
  if (head.cell_count > max_cells)
    return InputError(fmt::format(
        "{}: contains {} cells, but {{max_rays}} and {{memory}} allow only {}, because they are "
        "smaller than when the file was written",
        source.name(), head.cell_count, max_cells));
  return head;
}

using EntryCheck = std::function<Result<void>(const PlateEntries&)>;

Result<RaysFile> Read(entry_file::Source& source, size_t max_cells, ThreadPool& pool,
                      const EntryCheck& check) {
  LF_ASSIGN_OR_RETURN(entry_file::Front front, entry_file::ReadFront(source, sizeof(Head)));
  if (check) LF_RETURN_IF_ERROR(check(front.entries));
  LF_ASSIGN_OR_RETURN(const Head head, ReadHead(source, front.head, max_cells));
  RaysFile file = {std::move(front.entries),
                   RayMap(max_cells, head.cell_count, head.limit, head.is_too_coarse != 0)};
  uint64_t cells_left = head.cell_count;
  for (size_t first = 0; first < RayMap::kShards; first += Together(pool)) {
    std::vector<Part> parts(std::min(Together(pool), RayMap::kShards - first));
    for (size_t i = 0; i < parts.size(); ++i) {
      Part& part = parts[i];
      LF_RETURN_IF_ERROR(source.Read(&part.head, sizeof(part.head)));
      if (part.head.cell_count > cells_left)
        return source.Damaged(fmt::format("shard {}: {} cells, at most {} were expected", first + i,
                                          part.head.cell_count, cells_left));
      cells_left -= part.head.cell_count;
      part.cells.resize(part.head.cell_count);
      LF_RETURN_IF_ERROR(source.Read(part.cells.data(), BytesOf(part.cells).size()));
    }
    std::array<std::string, kMostTogether> faults;
    pool.ForEach(parts.size(), [&](size_t i) {
      faults[i] = FaultOf(parts[i], first + i, file.map);
      if (faults[i].empty()) file.map.Restore(first + i, parts[i].cells);
    });
    for (const std::string& fault : faults)
      if (!fault.empty()) return source.Damaged(fault);
  }
  if (cells_left != 0)
    return source.Damaged(
        fmt::format("its shards lack {} of {} cells", cells_left, head.cell_count));
  return file;
}

}  // namespace

Result<void> WriteRays(const fs::path& path, const PlateEntries& entries, const RayMap& map,
                       ThreadPool& pool) {
  return WriteAtomically(
      path, [&](const fs::path& temporary) { return Write(temporary, entries, map, pool); });
}

Result<RaysFile> ReadRays(const fs::path& path, size_t max_cells, ThreadPool& pool,
                          const EntryCheck& check) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<entry_file::Source> source,
                      entry_file::Source::OfFile(path, kKind));
  return Read(*source, max_cells, pool, check);
}

Result<RaysFile> ReadRaysOfBytes(std::string_view bytes, const std::string& name, size_t max_cells,
                                 ThreadPool& pool) {
  return Read(*entry_file::Source::OfBytes(bytes, name, kKind), max_cells, pool, {});
}

}  // namespace lf
