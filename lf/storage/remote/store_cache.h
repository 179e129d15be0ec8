// SPDX-License-Identifier: Apache-2.0
// Keeps local copies of packed stores on web servers (doc/remote_stores.md).
//
// Each store has a folder of its own in the cache, which only its owner may read. The folder holds
// the tables FIELD.lfs, a text file FIELD.lfs.url, the ranges of the parts that were read so far
// (copied_file.h), and a file in_use, whose time of change is that of the last use. Processes may
// use a folder at the same time; only the download of the tables waits for others. A folder in use
// is never removed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/storage/remote/remote_options.h"

namespace lf {

struct StoreCacheOptions {
  // Folder of the cache, from which nothing is removed; unset: lfrendertools/stores in
  // XDG_CACHE_HOME or, without this variable, in ~/.cache. From that one, stores are removed that
  // were not used for the longest time, and not within the last day, until it takes at most
  // most_cached_bytes.
  std::optional<std::filesystem::path> folder = {};
  uint64_t most_cached_bytes = uint64_t{16} << 30;
  // A larger file FIELD.lfs is not downloaded, because it is no store made by resolution: the
  // tables of a million LF images take 0.5 GB.
  uint64_t most_table_bytes = uint64_t{1} << 30;
  RemoteOptions remote = {};
};

// Copies the tables of a packed store into the cache, unless they are there and unchanged on the
// server. Returns the path of the local FIELD.lfs, a packed store whose parts are read from the
// server (CopiedFile). If the tables have changed, removes what was copied before. An interrupted
// download is resumed. If the server cannot be reached and there is a copy, warns and returns it.
// If the cache cannot be written, warns and copies the tables into a temporary folder, which is
// removed when the program ends.
// kUsage as CheckStoreUrl() (store_url.h). kInput: the file is too large. kOutput: neither folder
// can be written. Errors of RemoteFile.
Result<std::filesystem::path> OpenRemoteStore(const std::string& url,
                                              const StoreCacheOptions& options = {});

// Returns the URL that FIELD.lfs.url states for the store FIELD.lfs; nullopt if there is no such
// file. kInput: the file is damaged.
Result<std::optional<std::string>> UrlOfStore(const std::filesystem::path& store);

}  // namespace lf
