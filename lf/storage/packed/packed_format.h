// SPDX-License-Identifier: Apache-2.0
// Definitions that the writer and the reader of packed stores share. Internal to this folder.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/storage/sqlite/database.h"
#include "lf/storage/tables/calibration_tables.h"

namespace lf {

// Page size of SQLite. On average half a page is wasted for each encoded image: 16 % of an image of
// 200 kB with pages of 64 KiB, 4 % with these pages of 16 KiB.
inline constexpr int kPageBytes = 16384;
inline constexpr DatabaseFormat kStoreFormat = {"packed store", 0x4C465053 /* "LFPS" */, 1,
                                                kPageBytes};
inline constexpr DatabaseFormat kShardFormat = {"shard of a packed store", 0x4C465348 /* "LFSH" */,
                                                1, kPageBytes};

// Returns the identity of the LF images that a packed store lists. It does not cover mask files,
// because a store holds masks with the encoded images.
LightFieldIdentity IdentityInStore(const LightField& light_field);

// Tables of a store besides settings and intrinsics (doc/formats/packed_store.md).
inline constexpr const char* kStoreTables = R"(
create table lf_images (id integer primary key, whole_id integer, name text not null,
  intrinsics integer, gain real, x real, y real, z real, pose blob);
create index lf_images_by_name on lf_images (name);
create table codes (id integer primary key, shard integer, kind text, x_begin integer,
  y_begin integer, x_end integer, y_end integer, bytes integer, source_bytes integer);)";
// Table of the encoded images, in the file of the store or in its shards.
inline constexpr const char* kBlobsTable =
    "create table blobs (id integer primary key, code blob not null, mask blob);";
// Table of their fronts (code_fronts.h), in the same file. Stores of earlier builds lack it.
inline constexpr const char* kFrontsTable =
    "create table fronts (id integer primary key, fronts blob not null);";
inline constexpr const char* kFrontsName = "fronts";

// Table of a store by resolution, in place of `blobs` and `fronts`: where the bytes of each encoded
// image are in its parts (part_file.h).
inline constexpr const char* kRangesTable =
    "create table ranges (id integer primary key, ranges blob not null);";

// Further tables of a densified store.
inline constexpr const char* kDensifiedTables = R"(
create table virtual_images (id integer primary key);
create table planes (id integer, kind text, plane blob not null, primary key (id, kind));)";
inline constexpr const char* kVirtualTable = "virtual_images";

// Further table of a store that leaves out LF images on purpose. A densified store leaves out none.
inline constexpr const char* kLeftOutName = "left_out";
inline constexpr const char* kLeftOutTable = "create table left_out (id integer primary key);";
// Further table of a store of predicted LF images: the ids of their reference images
// (reference_table.h). Such a store is not by resolution, and has fronts.
inline constexpr const char* kPredictedName = "predicted";
inline constexpr const char* kPredictedTable =
    "create table predicted (id integer primary key, reference_ids blob not null);";
// Setting that only a store of predicted LF images has.
inline constexpr const char* kPredictedKey = "predicted";
// Setting that only a densified store has.
inline constexpr const char* kDensifiedKey = "densified";

// Opens the file of a packed store for reading. It has the table of encoded images unless the store
// has shards or is by resolution.
inline Result<Database> OpenStoreDatabase(const std::filesystem::path& path) {
  const std::string tables = fmt::format("{}{}{}", kSettingsTable, kIntrinsicsTable, kStoreTables);
  const std::string blobs = kBlobsTable;
  std::vector<std::string> scripts;
  for (const std::string& of_images :
       {blobs + kFrontsTable, std::string(), std::string(kRangesTable), blobs})
    for (const char* const further : {"", kDensifiedTables, kLeftOutTable})
      scripts.push_back(tables + of_images + further);
  for (const std::string& of_images : {blobs + kFrontsTable, std::string()})
    for (const char* const further : {"", kDensifiedTables, kLeftOutTable})
      scripts.push_back(tables + of_images + further + kPredictedTable);
  return Database::Open(path, kStoreFormat, scripts);
}
inline Result<Database> OpenShardDatabase(const std::filesystem::path& path) {
  const std::string tables = fmt::format("{}{}", kSettingsTable, kBlobsTable);
  return Database::Open(path, kShardFormat, {tables + kFrontsTable, tables});
}

// The file of a complete packed store, and its settings.
struct OpenedStore {
  Database database;
  Settings settings;
};
// kInput: the file cannot be read, or is no complete packed store.
Result<OpenedStore> OpenComplete(const std::filesystem::path& path);

// Name of each StoredValues in the column `kind` of the table `codes`, in the order of the
// enumeration.
inline constexpr const char* kKindNames[] = {"uint8", "uint16", "half", "display16", "file"};

inline constexpr const char* kComplete = "complete";
inline constexpr const char* kUnfinished = "unfinished";
inline constexpr int kMostShards = 9999;

// Returns the path of a shard: "films/a-0003.lfs" for shard 3 of the store "films/a.lfs".
inline std::filesystem::path ShardPath(const std::filesystem::path& store, int number) {
  return store.parent_path() /
         fmt::format("{}-{:04}{}", store.stem().string(), number, store.extension().string());
}

// Returns the path that the file of a store or shard has while it is being written.
inline std::filesystem::path UnfinishedPath(std::filesystem::path path) {
  return path += ".unfinished";
}

}  // namespace lf
