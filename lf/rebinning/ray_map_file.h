// SPDX-License-Identifier: Apache-2.0
// Rebinned rays as one file: entries that state the inputs and the progress of rebinning, and all
// cells of a map (doc/formats/rays.md). Interrupted rebinning resumes from such a file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/plate_file.h"
#include "lf/rebinning/ray_map.h"

namespace lf {

// Writes the map atomically (core/file.h). The bytes depend only on the entries and the content of
// the map, not on the order of its rays or the number of threads. Needs up to an eighth of the
// cells' memory in addition to the map. The entries have the same form as in plate files. kOutput:
// the folder or the disk cannot be written.
Result<void> WriteRays(const std::filesystem::path& path, const PlateEntries& entries,
                       const RayMap& map, ThreadPool& pool);

struct RaysFile {
  PlateEntries entries;
  RayMap map;
};

// Reads a file of WriteRays() with the threads of `pool`. If max_cells is the same as for the map
// that was written, the map behaves like that map from then on: adding rays and trimming lead to
// the same bits. Needs up to an eighth of the cells' memory in addition to the map. kInput: the
// file cannot be read, is not of this kind or version, is damaged, or has more cells than
// max_cells. The message names file and reason.
//   check  is called with the entries before the cells are read; its error is returned
Result<RaysFile> ReadRays(const std::filesystem::path& path, size_t max_cells, ThreadPool& pool,
                          const std::function<Result<void>(const PlateEntries&)>& check = {});
// Reads a file of WriteRays() from bytes in memory; messages call the file `name`.
Result<RaysFile> ReadRaysOfBytes(std::string_view bytes, const std::string& name, size_t max_cells,
                                 ThreadPool& pool);

}  // namespace lf
