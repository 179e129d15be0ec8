// Rebinned rays as one file: what they were made from, how far they are, and every cell of a map
// (doc/formats/rays.md). Interrupted rebinning goes on from one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/plate/plate_file.h"
#include "lf/rebinning/ray_map.h"

namespace lf {

// Writes the map atomically (core/file.h). The bytes depend on the entries and on what the map
// holds alone: not on the order of its rays, and not on the threads. Needs up to an eighth of the
// cells' memory beside the map. The entries are as those of plates.
// kOutput: the folder, the disk.
Result<void> WriteRays(const std::filesystem::path& path, const PlateEntries& entries,
                       const RayMap& map, ThreadPool& pool);

struct RaysFile {
  PlateEntries entries;
  RayMap map;
};

// Reads such a file, by the threads of `pool`. With the max_cells of the map that was written, the
// one read gives the same answers ever after: rays may be added, and it may be trimmed, to the same
// bits. Needs up to an eighth of the cells' memory beside the map.
// kInput: cannot be read, no such file, of another version, more cells than max_cells, or damaged;
// the message names file and reason.
//   check  is asked about the entries before the cells are read; its error is given back
Result<RaysFile> ReadRays(const std::filesystem::path& path, size_t max_cells, ThreadPool& pool,
                          const std::function<Result<void>(const PlateEntries&)>& check = {});
// The same for a file in memory; `name` is what messages call it.
Result<RaysFile> ReadRaysOfBytes(std::string_view bytes, const std::string& name, size_t max_cells,
                                 ThreadPool& pool);

}  // namespace lf
