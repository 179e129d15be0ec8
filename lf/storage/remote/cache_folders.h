// SPDX-License-Identifier: Apache-2.0
// The folders of a cache of stores. Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>

#include "lf/core/result.h"

namespace lf {

// Returns lfrendertools/stores in the cache folder of the user (XDG_CACHE_HOME, or ~/.cache).
// kOutput: neither XDG_CACHE_HOME nor HOME is an absolute path.
Result<std::filesystem::path> DefaultCacheFolder();

// Returns a temporary folder of this process, which is removed when the program ends. kOutput if it
// cannot be made.
Result<std::filesystem::path> TemporaryCacheFolder();

// Makes the folder of a store, and the folders above it. Only its owner may read it. kOutput if
// that fails.
Result<void> MakeCacheFolder(const std::filesystem::path& folder);

// Marks the folder of a store as used, until the program ends. kOutput if its files cannot be
// written.
Result<void> UseCacheFolder(const std::filesystem::path& folder);

// Removes the stores in `cache` that were not used for the longest time, until the others take at
// most `most_bytes` of the disk. Stores stay that a program uses, or that were used within the last
// day.
void RemoveOldStores(const std::filesystem::path& cache, uint64_t most_bytes);

}  // namespace lf
