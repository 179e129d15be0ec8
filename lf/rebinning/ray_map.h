// Rebinned rays: what was recorded in each cell of a slab, in memory that does not grow beyond a
// limit (thesis 4.3.2).
//
// A cell has the sums of its rays' linear 16-bit values, and how many they are. Where more cells
// are found than may be kept, those of the smallest hashes are: the hash above which cells are
// dropped is lowered step by step, by 1/8. A cell below it was never dropped, so what is kept
// depends on which rays were given, never on their order or the number of threads.
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
  // More would not fit; so many LF pixels in one cell are cells that are far too wide.
  static constexpr uint32_t kMostRays = 65537;

  CellKey cell = 0;  // 0: none
  std::array<uint32_t, 3> rgb = {};
  uint32_t count = 0;

  // False: it has kMostRays already.
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
  // Parts that are filled at the same time; the same whatever the number of threads.
  static constexpr size_t kShards = 32;

  // max_cells       that Trim() leaves; at least 1
  // expected_cells  there is memory for these from the beginning, up to max_cells
  explicit RayMap(size_t max_cells, size_t expected_cells = SIZE_MAX);

  // The same for a map that was written to a file (ray_map_file.h): Restore() brings its cells.
  RayMap(size_t max_cells, size_t expected_cells, uint64_t limit, bool is_too_coarse);

  static size_t ShardOf(CellKey cell) { return MixBits(cell) % kShards; }

  // Adds rays to the cells that they are in. All are of the shard. Shards may be added to at the
  // same time. A ray that its cell has no room for makes is_too_coarse().
  void Add(size_t shard, std::span<const BinnedRay> rays);
  // The same, but makes no new cells.
  void AddToThoseThere(size_t shard, std::span<const BinnedRay> rays);

  // Puts back cells that another map of this limit had. All are of the shard, different, and none
  // is there. Shards may be restored at the same time.
  void Restore(size_t shard, std::span<const BinnedCell> cells);

  // Drops cells of the largest hashes until there are no more than max_cells.
  void Trim(ThreadPool& pool);

  // Drops the cells that are not wanted any more. There is room for others then: cells of all
  // hashes may be made again, of rays to come.
  void DropUnless(const std::function<bool(CellKey)>& is_wanted, ThreadPool& pool);

  // Whether a cell may still be made: rays of others need not be looked at.
  bool MayHold(CellKey cell) const { return MixBits(cell) < limit_; }
  // The hash that those of all cells are below.
  uint64_t limit() const { return limit_; }

  // Whether some cell got more rays than it can hold: its sums are wrong.
  bool is_too_coarse() const;

  size_t size() const;
  size_t size_bytes() const;

  // All cells, by ascending keys: row by row of the uv plane.
  std::vector<BinnedCell> Cells(ThreadPool& pool) const;
  // Those of a shard, by ascending keys.
  std::vector<BinnedCell> CellsOf(size_t shard) const;

 private:
  // Open addressing: a cell is where its hash says, or behind it, before the next gap.
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
