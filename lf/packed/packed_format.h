// What writer and reader of packed stores share. Internal to packed.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "lf/calibration_tables/calibration_tables.h"
#include "lf/capture/light_field.h"
#include "lf/capture/light_field_identity.h"
#include "lf/database/database.h"

namespace lf {

// Of each code half a page is empty: of 200 kB 16 % with 64 KiB, 4 % with these.
inline constexpr int kPageBytes = 16384;
inline constexpr DatabaseFormat kStoreFormat = {"packed store", 0x4C465053 /* "LFPS" */, 1,
                                                kPageBytes};
inline constexpr DatabaseFormat kShardFormat = {"shard of a packed store", 0x4C465348 /* "LFSH" */,
                                                1, kPageBytes};

// Of the LF images as a store lists them: their masks are within the codes.
LightFieldIdentity IdentityInStore(const LightField& light_field);

// Settings, intrinsics and these, as doc/formats/packed_store.md describes them.
inline constexpr const char* kStoreTables = R"(
create table lf_images (id integer primary key, whole_id integer, name text not null,
  intrinsics integer, gain real, x real, y real, z real, pose blob);
create index lf_images_by_name on lf_images (name);
create table codes (id integer primary key, shard integer, kind text, x_begin integer,
  y_begin integer, x_end integer, y_end integer, bytes integer, source_bytes integer);)";
// Here, or in the shards.
inline constexpr const char* kBlobsTable =
    "create table blobs (id integer primary key, code blob not null, mask blob);";

// A store has its codes itself, or in shards.
inline Result<Database> OpenStoreDatabase(const std::filesystem::path& path) {
  const std::string tables = fmt::format("{}{}{}", kSettingsTable, kIntrinsicsTable, kStoreTables);
  return Database::Open(path, kStoreFormat, {tables + kBlobsTable, tables});
}
inline Result<Database> OpenShardDatabase(const std::filesystem::path& path) {
  return Database::Open(path, kShardFormat, {fmt::format("{}{}", kSettingsTable, kBlobsTable)});
}

// By StoredValues.
inline constexpr const char* kKindNames[] = {"uint8", "uint16", "half", "display16"};

inline constexpr const char* kComplete = "complete";
inline constexpr const char* kUnfinished = "unfinished";
inline constexpr int kMostShards = 9999;

// "films/a.lfs", 3: "films/a-0003.lfs"
inline std::filesystem::path ShardPath(const std::filesystem::path& store, int number) {
  return store.parent_path() /
         fmt::format("{}-{:04}{}", store.stem().string(), number, store.extension().string());
}

// While it is written.
inline std::filesystem::path UnfinishedPath(std::filesystem::path path) {
  return path += ".unfinished";
}

}  // namespace lf
