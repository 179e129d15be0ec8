// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/ray_map.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"

namespace lf {
namespace {

// Returns the number of slots that `cells` cells need. At most three quarters of the slots are
// filled, because searches in a fuller table are long.
size_t SlotsFor(size_t cells) { return cells + cells / 3 + 64; }

// Returns the slot where the search for a hash begins. Uses other bits of the hash than ShardOf()
// and the comparison with the limit do.
size_t FirstSlot(uint64_t hash, size_t slots) {
  const uint64_t bits = hash / RayMap::kShards & 0xffffffff;
  return static_cast<size_t>(bits * slots >> 32);
}

// Returns the slot that holds a cell, or the empty slot where it would be put.
BinnedCell* Find(LargeVector<BinnedCell>& slots, CellKey cell, uint64_t hash) {
  BinnedCell* slot = &slots[FirstSlot(hash, slots.size())];
  BinnedCell* const end = slots.data() + slots.size();
  while (slot->cell != cell && slot->cell != 0)
    if (++slot == end) slot = slots.data();
  return slot;
}

bool IsBefore(const BinnedCell& a, const BinnedCell& b) { return a.cell < b.cell; }

// The slots of consecutive rays are far apart in memory: each slot is prefetched kAhead rays before
// it is used.
constexpr size_t kAhead = 32;

// Returns the number of cells to expect in the fullest shard if all shards together have `cells`.
size_t MostOfShard(size_t cells) { return cells / RayMap::kShards * 9 / 8 + 64; }

// Returns the number of slots to which a full shard grows: twice as many, but not beyond the number
// that max_cells cells need. A shard that needs still more before the next Trim() grows by a
// quarter.
size_t GrownSlots(size_t slots, size_t max_cells) {
  const size_t most = SlotsFor(MostOfShard(max_cells));
  return slots < most ? std::min(2 * slots, most) : slots + slots / 4;
}

}  // namespace

// Allocates memory for the expected cells at once. Growing later would take longer than adding the
// cells does, and so would allocating memory that is never used.
RayMap::RayMap(size_t max_cells, size_t expected_cells)
    : max_cells_(std::max<size_t>(max_cells, 1)) {
  const size_t cells = std::min(max_cells_, expected_cells);
  for (Shard& shard : shards_) shard.slots.resize(SlotsFor(MostOfShard(cells)));
}

RayMap::RayMap(size_t max_cells, size_t expected_cells, uint64_t limit, bool is_too_coarse)
    : RayMap(max_cells, expected_cells) {
  limit_ = limit;
  shards_[0].is_too_coarse = is_too_coarse;  // is_too_coarse() combines the flags of all shards
}

size_t RayMap::BytesFor(size_t max_cells, size_t expected_cells, size_t cells) {
  size_t slots = SlotsFor(MostOfShard(std::min(std::max<size_t>(max_cells, 1), expected_cells)));
  while (slots < SlotsFor(cells / kShards)) slots = GrownSlots(slots, max_cells);
  return kShards * slots * sizeof(BinnedCell);
}

void RayMap::Grow(Shard& shard) {
  LargeVector<BinnedCell> slots(GrownSlots(shard.slots.size(), max_cells_));
  for (const BinnedCell& cell : shard.slots)
    if (cell.cell != 0) *Find(slots, cell.cell, MixBits(cell.cell)) = cell;
  shard.slots = std::move(slots);
}

template <bool kMakesNew>
void RayMap::AddTo(Shard& shard, std::span<const BinnedRay> rays) {
  std::array<uint64_t, kAhead> hashes{};
  const auto announce = [&](size_t i) {
    hashes[i % kAhead] = MixBits(rays[i].cell);
    // A slot may begin in one cache line and end in the next.
    const BinnedCell* const slot = &shard.slots[FirstSlot(hashes[i % kAhead], shard.slots.size())];
    __builtin_prefetch(slot, 1);
    __builtin_prefetch(&slot->count, 1);
  };
  for (size_t i = 0; i < std::min(kAhead, rays.size()); ++i) announce(i);
  for (size_t i = 0; i < rays.size(); ++i) {
    const uint64_t hash = hashes[i % kAhead];
    if (i + kAhead < rays.size()) announce(i + kAhead);
    if (hash >= limit_) continue;
    BinnedCell* slot = Find(shard.slots, rays[i].cell, hash);
    if (slot->cell == 0) {
      if (!kMakesNew) continue;
      if (SlotsFor(shard.count + 1) > shard.slots.size()) {
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

void RayMap::Restore(size_t shard, std::span<const BinnedCell> cells) {
  Shard& to = shards_[shard];
  while (SlotsFor(to.count + cells.size()) > to.slots.size()) Grow(to);
  for (size_t i = 0; i < cells.size(); ++i) {
    if (i + kAhead < cells.size()) {
      const uint64_t hash = MixBits(cells[i + kAhead].cell);
      __builtin_prefetch(&to.slots[FirstSlot(hash, to.slots.size())], 1);
    }
    *Find(to.slots, cells[i].cell, MixBits(cells[i].cell)) = cells[i];
  }
  to.count += cells.size();
}

void RayMap::DropUnless(const std::function<bool(CellKey)>& is_wanted, Shard& shard) {
  LargeVector<BinnedCell> slots(shard.slots.size());
  shard.count = 0;
  for (const BinnedCell& cell : shard.slots) {
    if (cell.cell == 0 || !is_wanted(cell.cell)) continue;
    *Find(slots, cell.cell, MixBits(cell.cell)) = cell;
    ++shard.count;
  }
  shard.slots = std::move(slots);
}

void RayMap::Trim(ThreadPool& pool) {
  while (size() > max_cells_) {
    limit_ -= std::max<uint64_t>(1, limit_ / 8);
    const auto may_stay = [this](CellKey cell) { return MayHold(cell); };
    pool.ForEach(kShards, [&](size_t i) { DropUnless(may_stay, shards_[i]); });
  }
}

void RayMap::DropUnless(const std::function<bool(CellKey)>& is_wanted, ThreadPool& pool) {
  limit_ = UINT64_MAX;
  pool.ForEach(kShards, [&](size_t i) { DropUnless(is_wanted, shards_[i]); });
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

std::vector<BinnedCell> RayMap::Cells(ThreadPool& pool) const {
  // Cells are first distributed by the highest 16 bits of their keys (the letter), and then sorted
  // in parts by all threads. A part consists of all cells of some letters; all parts have about the
  // same number of cells.
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
              begin + static_cast<std::ptrdiff_t>(part_begins[i + 1]), IsBefore);
  });
  return cells;
}

std::vector<BinnedCell> RayMap::CellsOf(size_t shard) const {
  std::vector<BinnedCell> cells;
  cells.reserve(shards_[shard].count);
  for (const BinnedCell& cell : shards_[shard].slots)
    if (cell.cell != 0) cells.push_back(cell);
  std::sort(cells.begin(), cells.end(), IsBefore);
  return cells;
}

}  // namespace lf
