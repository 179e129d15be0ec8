// SPDX-License-Identifier: Apache-2.0
// Tells to which store a file belongs, and removes the files of an unfinished store. Internal to
// this folder.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns the id that a store states for itself; empty if the file cannot be read as a store.
std::string StoreIdOf(const std::filesystem::path& path);
// Returns the id that a shard states for its store; empty if the file cannot be read as a shard.
std::string StoreOfShard(const std::filesystem::path& path);

// Removes an unfinished store and all its shards or parts, both those with names of unfinished
// files and those that already have their final names.
void RemoveUnfinishedFiles(const std::filesystem::path& path);

}  // namespace lf
