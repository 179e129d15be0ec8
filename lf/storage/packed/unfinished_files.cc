// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/unfinished_files.h"

#include <system_error>
#include <utility>

#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/part_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

void RemoveWithJournal(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
  fs::remove(fs::path(path) += "-journal", ignored);
}

// Returns the id that a store states for itself, or a shard for its store; empty if the file cannot
// be read as `format`.
std::string StoreIdIn(Result<Database> database, const DatabaseFormat& format) {
  if (!database) return {};
  const Result<Settings> settings = Settings::Read(*database, format.name);
  return settings ? settings->Text("store") : std::string();
}

}  // namespace

std::string StoreIdOf(const fs::path& path) {
  return StoreIdIn(OpenStoreDatabase(path), kStoreFormat);
}
std::string StoreOfShard(const fs::path& path) {
  return StoreIdIn(OpenShardDatabase(path), kShardFormat);
}

void RemoveUnfinishedFiles(const fs::path& path) {
  const std::string store = StoreIdOf(UnfinishedPath(path));
  RemoveWithJournal(UnfinishedPath(path));
  std::error_code error;
  for (size_t number = 0; number < kMostParts; ++number) {
    const fs::path part = PartPath(path, number);
    fs::remove(UnfinishedPath(part), error);
    if (!store.empty() && StoreOfPart(part) == store) fs::remove(part, error);
  }
  for (int n = 1; n <= kMostShards; ++n) {
    const fs::path shard = ShardPath(path, n), unfinished = UnfinishedPath(shard);
    const bool is_unfinished = fs::exists(unfinished, error);
    const bool is_ours = !store.empty() && StoreOfShard(shard) == store;
    if (!is_unfinished && !is_ours) return;
    RemoveWithJournal(unfinished);
    if (is_ours) fs::remove(shard, error);
  }
}

}  // namespace lf
