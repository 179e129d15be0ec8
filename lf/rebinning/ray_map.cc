#include "lf/rebinning/ray_map.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr size_t kFewestSlots = 64;

// Slots are filled to three quarters at most: beyond, what is looked for is far from its place.
bool IsFull(size_t count, size_t slots) { return 4 * count >= 3 * slots; }

size_t FirstSlot(uint64_t hash, size_t slots) { return (hash / RayMap::kShards) & (slots - 1); }

// Where a cell is, or would be.
BinnedCell* Find(LargeVector<BinnedCell>& slots, CellKey cell, uint64_t hash) {
  const size_t mask = slots.size() - 1;
  for (size_t i = FirstSlot(hash, slots.size());; i = (i + 1) & mask)
    if (slots[i].cell == cell || slots[i].cell == 0) return &slots[i];
}

}  // namespace

RayMap::RayMap(size_t max_cells) : max_cells_(std::max<size_t>(max_cells, 1)) {
  for (Shard& shard : shards_) shard.slots.resize(kFewestSlots);
}

void RayMap::Grow(Shard& shard) {
  LargeVector<BinnedCell> slots(2 * shard.slots.size());
  for (const BinnedCell& cell : shard.slots)
    if (cell.cell != 0) *Find(slots, cell.cell, MixBits(cell.cell)) = cell;
  shard.slots = std::move(slots);
}

template <bool kMakesNew>
void RayMap::AddTo(Shard& shard, std::span<const BinnedRay> rays) {
  // The slot of a ray is somewhere in memory: it is asked for some rays ahead.
  constexpr size_t kAhead = 16;
  std::array<uint64_t, kAhead> hashes{};
  const auto announce = [&](size_t i) {
    hashes[i % kAhead] = MixBits(rays[i].cell);
    __builtin_prefetch(&shard.slots[FirstSlot(hashes[i % kAhead], shard.slots.size())], 1);
  };
  for (size_t i = 0; i < std::min(kAhead, rays.size()); ++i) announce(i);
  for (size_t i = 0; i < rays.size(); ++i) {
    const uint64_t hash = hashes[i % kAhead];
    if (i + kAhead < rays.size()) announce(i + kAhead);
    if (hash >= limit_) continue;
    BinnedCell* slot = Find(shard.slots, rays[i].cell, hash);
    if (slot->cell == 0) {
      if (!kMakesNew) continue;
      if (IsFull(shard.count + 1, shard.slots.size())) {
        Grow(shard);
        slot = Find(shard.slots, rays[i].cell, hash);
      }
      slot->cell = rays[i].cell;
      ++shard.count;
    }
    if (!slot->Add(rays[i])) shard.is_too_coarse = true;
  }
}

void RayMap::Add(size_t shard, std::span<const BinnedRay> rays) {
  AddTo<true>(shards_[shard], rays);
}
void RayMap::AddToThoseThere(size_t shard, std::span<const BinnedRay> rays) {
  AddTo<false>(shards_[shard], rays);
}

void RayMap::DropFrom(Shard& shard) const {
  LargeVector<BinnedCell> slots(shard.slots.size());
  shard.count = 0;
  for (const BinnedCell& cell : shard.slots) {
    const uint64_t hash = MixBits(cell.cell);
    if (cell.cell == 0 || hash >= limit_) continue;
    *Find(slots, cell.cell, hash) = cell;
    ++shard.count;
  }
  shard.slots = std::move(slots);
}

void RayMap::Trim(ThreadPool& pool) {
  while (size() > max_cells_) {
    limit_ -= limit_ / 8;
    pool.ForEach(kShards, [this](size_t i) { DropFrom(shards_[i]); });
  }
}

bool RayMap::is_too_coarse() const {
  return std::any_of(shards_.begin(), shards_.end(),
                     [](const Shard& shard) { return shard.is_too_coarse; });
}

size_t RayMap::size() const {
  size_t count = 0;
  for (const Shard& shard : shards_) count += shard.count;
  return count;
}

size_t RayMap::size_bytes() const {
  size_t bytes = 0;
  for (const Shard& shard : shards_) bytes += shard.slots.size() * sizeof(BinnedCell);
  return bytes;
}

size_t RayMap::BytesOf(size_t max_cells, size_t between) {
  // Some shards have more than others; and one grows into another twice as large beside it.
  const size_t most = (max_cells + between) / kShards + (max_cells + between) / (8 * kShards) + 64;
  const size_t slots = std::bit_ceil(most * 4 / 3 + 1);
  return (kShards + 1) * std::max(slots, kFewestSlots) * sizeof(BinnedCell);
}

std::vector<BinnedCell> RayMap::Cells(ThreadPool& pool) const {
  // By the first letters of their keys, then within these, by all threads. As many parts as make
  // about the same number of cells each, however they lie.
  constexpr size_t kParts = 256, kLetters = 1 << 16;
  const auto letter_of = [](const BinnedCell& cell) { return cell.cell >> 48; };
  const auto for_each_cell = [this](const auto& visit) {
    for (const Shard& shard : shards_)
      for (const BinnedCell& cell : shard.slots)
        if (cell.cell != 0) visit(cell);
  };
  std::vector<size_t> next(kLetters);
  for_each_cell([&](const BinnedCell& cell) { ++next[letter_of(cell)]; });
  std::vector<size_t> part_begins;
  size_t count = 0;
  for (size_t& of_letter : next) {
    if (count * kParts >= part_begins.size() * size()) part_begins.push_back(count);
    count += std::exchange(of_letter, count);
  }
  part_begins.push_back(count);
  std::vector<BinnedCell> cells(count);
  for_each_cell([&](const BinnedCell& cell) { cells[next[letter_of(cell)]++] = cell; });
  pool.ForEach(part_begins.size() - 1, [&](size_t i) {
    const auto begin = cells.begin();
    std::sort(begin + static_cast<std::ptrdiff_t>(part_begins[i]),
              begin + static_cast<std::ptrdiff_t>(part_begins[i + 1]),
              [](const BinnedCell& a, const BinnedCell& b) { return a.cell < b.cell; });
  });
  return cells;
}

}  // namespace lf
