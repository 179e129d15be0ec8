// SPDX-License-Identifier: Apache-2.0
// The layout of a file of rebinned rays (doc/formats/rays.md), for its writer and reader. Internal
// to rebinning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "lf/film/plate/entry_file.h"
#include "lf/rebinning/ray_map.h"

namespace lf::ray_map_format {

inline constexpr entry_file::Kind kKind = {"LFCELLS\n", 2, "file of rays",
                                           "the rays in it cannot be used"};

// The file begins with this head. The text of the entries follows, then the hash of head and text,
// then for each shard a ShardHead and the shard's cells.
struct Head {
  char magic[8];
  uint32_t version;
  uint32_t text_bytes;
  uint32_t shard_count;
  uint32_t is_too_coarse;  // RayMap::is_too_coarse(): 0 or 1
  uint64_t limit;          // RayMap::limit()
  uint64_t cell_count;
};
static_assert(sizeof(Head) == 40);

// The head that precedes the cells of each shard.
struct ShardHead {
  uint64_t cell_count;
  uint64_t hash;  // XXH3 of the cells, seeded by the number of the shard
};
static_assert(sizeof(ShardHead) == 16);

// Cells are in the file as they are in memory.
static_assert(sizeof(BinnedCell) == 24 && offsetof(BinnedCell, rgb) == 8 &&
              offsetof(BinnedCell, count) == 20 && std::is_trivially_copyable_v<BinnedCell>);

}  // namespace lf::ray_map_format
