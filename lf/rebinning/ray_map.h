// SPDX-License-Identifier: Apache-2.0
// Rebinned rays: the radiance recorded in each cell of a slab, in memory that does not grow beyond
// a limit (thesis 4.3.2).
//
// A cell holds the sums of its rays' linear 16-bit values, and the number of these rays. If there
// are more cells than may be kept, the cells with the smallest hashes are kept: a limit, at and
// above which hashes are dropped, is lowered by an eighth at a time. A cell whose hash is below the
// limit was never dropped, so the kept cells depend only on which rays were added, never on their
// order or the number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lf/core/large_vector.h"
#include "lf/core/parallel.h"
#include "lf/core/random.h"
#include "lf/rebinning/slab.h"

namespace lf {

struct BinnedRay {
  CellKey cell = 0;
  std::array<uint16_t, 3> rgb = {};
};

struct BinnedCell {
  // Largest number of rays in a cell: the sums of more rays may not fit into 32 bits. Cells are far
  // too wide if one of them gets this many rays.
  static constexpr uint32_t kMostRays = 65537;

  CellKey cell = 0;  // key of the cell; 0: the slot is empty
  std::array<uint32_t, 3> rgb = {};
  uint32_t count = 0;

  // Returns false, and adds nothing, if the cell has kMostRays already.
  bool Add(const BinnedRay& ray) {
    if (count == kMostRays) return false;
    for (size_t c = 0; c < rgb.size(); ++c) rgb[c] += ray.rgb[c];
    ++count;
    return true;
  }
  double Mean(int channel) const { return static_cast<double>(rgb[channel]) / count; }
  friend bool operator==(const BinnedCell&, const BinnedCell&) = default;
};

class RayMap {
 public:
  // Number of shards, which are parts of the map that may be filled at the same time. It does not
  // depend on the number of threads.
  static constexpr size_t kShards = 32;

  //   max_cells       number of cells that Trim() leaves at most; at least 1
  //   expected_cells  memory for this number of cells, but at most for max_cells, is allocated at
  //                   once
  explicit RayMap(size_t max_cells, size_t expected_cells = SIZE_MAX);

  // Constructs an empty map with the limit() and is_too_coarse() of a map that was written to a
  // file (ray_map_file.h). Restore() adds the cells of that map.
  RayMap(size_t max_cells, size_t expected_cells, uint64_t limit, bool is_too_coarse);

  static size_t ShardOf(CellKey cell) { return MixBits(cell) % kShards; }

  // Adds rays to their cells; makes cells that are not yet in the map. Ignores rays for whose cells
  // MayHold() is false. The cells of all rays must belong to the shard (ShardOf()). Several threads
  // may add to different shards at the same time. is_too_coarse() becomes true if a cell has no
  // room for a ray.
  void Add(size_t shard, std::span<const BinnedRay> rays);
  // Like Add(), but skips rays whose cell is not in the map.
  void AddToThoseThere(size_t shard, std::span<const BinnedRay> rays);

  // Adds cells of another map that has the same limit. They must belong to the shard, be all
  // different, and not be in this map yet. Several threads may restore different shards at the same
  // time.
  void Restore(size_t shard, std::span<const BinnedCell> cells);

  // Drops the cells with the largest hashes until there are no more than max_cells.
  void Trim(ThreadPool& pool);

  // Drops the cells for which is_wanted() is false, and resets the limit: rays that are added later
  // may make cells of any hash again.
  void DropUnless(const std::function<bool(CellKey)>& is_wanted, ThreadPool& pool);

  // True if the cell's hash is below the limit. The rays of other cells can be skipped, because
  // Add() would ignore them.
  bool MayHold(CellKey cell) const { return MixBits(cell) < limit_; }
  // Exclusive upper bound of the hashes of all cells.
  uint64_t limit() const { return limit_; }

  // True if a cell got more rays than it can hold. Its sums lack the rays beyond kMostRays.
  bool is_too_coarse() const;

  size_t size() const;
  size_t size_bytes() const;
  // Returns the approximate size_bytes() of a map that was constructed with max_cells and
  // expected_cells, and holds `cells` cells.
  static size_t BytesFor(size_t max_cells, size_t expected_cells, size_t cells);

  // Returns all cells, sorted by ascending keys: row by row of the uv plane.
  std::vector<BinnedCell> Cells(ThreadPool& pool) const;
  // Returns the cells of a shard, sorted by ascending keys.
  std::vector<BinnedCell> CellsOf(size_t shard) const;

 private:
  // Hash table with open addressing: a cell is in the slot that its hash names, or in one of the
  // following slots before the next empty one.
  struct Shard {
    LargeVector<BinnedCell> slots;
    size_t count = 0;
    bool is_too_coarse = false;
  };
  template <bool kMakesNew>
  void AddTo(Shard& shard, std::span<const BinnedRay> rays);
  void Grow(Shard& shard);
  static void DropUnless(const std::function<bool(CellKey)>& is_wanted, Shard& shard);

  size_t max_cells_;
  uint64_t limit_ = UINT64_MAX;
  std::array<Shard, kShards> shards_;
};

}  // namespace lf
