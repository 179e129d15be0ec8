// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/packed_store_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/storage/packed/blob_table.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/part_file.h"
#include "lf/storage/packed/part_set.h"
#include "lf/storage/packed/plan_settings.h"
#include "lf/storage/packed/plane_table.h"
#include "lf/storage/packed/reference_rows.h"
#include "lf/storage/packed/store_tables.h"
#include "lf/storage/packed/unfinished_files.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kImagesPerBatch = 64;
constexpr std::chrono::seconds kBatchAge{2};

uint64_t BytesInStore(const CodedImage& image) { return image.code.size() + image.mask.size(); }

Result<bool> HasTables(Database* database) { return HasTable(database, "settings"); }

}  // namespace

bool PackedStorePlan::LeavesOut() const {
  return std::any_of(rects.begin(), rects.end(),
                     [](const PixelRect& rect) { return rect.empty(); });
}

struct PackedStoreWriter::State {
  fs::path path;
  std::optional<FileLock> lock;
  uint64_t shard_bytes = 0;
  std::string store;
  std::string replaced;                // id of the older store that has the final name; empty: none
  std::vector<uint64_t> source_bytes;  // CodedImage::source_bytes of each LF image that earlier
                                       // runs added; 0 for others

  std::mutex mutex;  // guards all members below
  std::vector<bool> has;
  std::optional<Database> database;
  std::optional<Statement> insert_code;
  std::optional<PlaneTable> planes;         // set if the store is densified
  std::optional<ReferenceRows> references;  // set if LF images may be predicted
  int shard_count = 0;
  uint64_t bytes_in_shard = 0;
  std::optional<Database> shard;           // the last shard, to which images are added
  std::optional<BlobTable> blobs;          // opened when the first LF image is added
  std::optional<PartSetWriter> parts;      // set if the store is by resolution
  std::optional<Statement> insert_ranges;  // set if `parts` is
  size_t batch_size = 0;
  std::chrono::steady_clock::time_point batch_begin;
  std::optional<Error> failed;

  ~State() {
    // Statements are closed before databases, and the lock is removed last.
    Close();
    if (lock) lock->Remove();
  }
  void Close() {
    blobs.reset();
    insert_ranges.reset();
    shard.reset();
    parts.reset();
    insert_code.reset();
    planes.reset();
    references.reset();
    database.reset();
  }

  Result<void> Read(const Settings& settings);
  Result<void> TakeShardsBack() const;
  Result<void> CheckIsFree(const fs::path& file, const std::string& of) const;
  Result<void> OpenParts(const Settings& settings);
  Result<void> OpenShard(int number);
  Result<void> BeginInBatch();
  Result<void> InsertBlob(LfImageId id, const CodedImage& image);
  Result<void> InsertRanges(LfImageId id, const CodedImage& image);
  Result<void> MakeRoom(uint64_t bytes);
  bool IsAddable(LfImageId id, const CodedImage& image) const;
  Result<void> Insert(LfImageId id, const CodedImage& image);
  Result<void> AddPlane(LfImageId id, PlaneKind kind, PlaneSize size, std::string_view code);
  Result<void> CommitIfDue();
  Result<void> CommitBatch();
  Result<void> WritePartBytes();
  Result<void> FinishFiles();
  // Returns `result`, and remembers an error, after which nothing can be added.
  Result<void> Kept(Result<void> result) {
    if (!result) failed = result.error();
    return result;
  }
};

// Reads the id of a store that is resumed, its number of shards, and which LF images it has.
Result<void> PackedStoreWriter::State::Read(const Settings& settings) {
  store = settings.Text("store");
  LF_ASSIGN_OR_RETURN(const double shards, settings.Number("shards", 0, kMostShards));
  shard_count = static_cast<int>(shards);
  return ForEachRow(
      *database, "select id, shard, bytes, source_bytes from codes",
      [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0));
        LF_ASSIGN_OR_RETURN(const int64_t of_shard, row.Integer(1, 0, shard_count));
        LF_ASSIGN_OR_RETURN(const int64_t bytes, row.Integer(2, 1, INT64_MAX));
        LF_ASSIGN_OR_RETURN(const int64_t sources, row.Integer(3, 0, INT64_MAX));
        if (id < 0 || static_cast<size_t>(id) >= has.size())
          return settings.Damaged(fmt::format(
              "it has an encoded image of LF image {}, which the light field lacks", id));
        has[static_cast<size_t>(id)] = true;
        source_bytes[static_cast<size_t>(id)] = static_cast<uint64_t>(sources);
        if (of_shard == shard_count) bytes_in_shard += static_cast<uint64_t>(bytes);
        return {};
      });
}

// Renames shards that already have their final names back to the names of unfinished shards. They
// have final names if an earlier writer was killed while it finished the store.
Result<void> PackedStoreWriter::State::TakeShardsBack() const {
  std::error_code error;
  for (int n = 1; n <= shard_count; ++n) {
    const fs::path shard_path = ShardPath(path, n);
    if (fs::exists(UnfinishedPath(shard_path), error)) continue;
    if (StoreOfShard(shard_path) != store)
      return InputError(
          fmt::format("{}: this shard of the unfinished store is missing: start the store again "
                      "with {{lfcompressor overwrite}}",
                      UnfinishedPath(shard_path).string()));
    LF_RETURN_IF_ERROR(RenameFlushed(shard_path, UnfinishedPath(shard_path)));
  }
  return {};
}

// Returns kUsage if the path of a shard or part is taken by a file that belongs neither to this
// store nor to the store that is replaced.
//   of  id of the store that the file belongs to
Result<void> PackedStoreWriter::State::CheckIsFree(const fs::path& file,
                                                   const std::string& of) const {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return {};
  if (!of.empty() && (of == store || of == replaced)) return {};
  return UsageError(fmt::format(
      "{}: a file of the new store would replace this file, which belongs to "
      "no store of this name: give the store another name ({{output}}), or remove the file",
      file.string()));
}

// Opens the parts of a store by resolution, and takes those back that already have their final
// names, as TakeShardsBack() does for shards.
Result<void> PackedStoreWriter::State::OpenParts(const Settings& settings) {
  LF_ASSIGN_OR_RETURN(const size_t part_count, PlannedParts(settings));
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> bytes, StatedPartBytes(settings));
  for (size_t number = 0; number < part_count; ++number) {
    const fs::path part = PartPath(path, number), unfinished = UnfinishedPath(part);
    LF_RETURN_IF_ERROR(CheckIsFree(part, StoreOfPart(part)));
    std::error_code error;
    if (!fs::exists(unfinished, error) && StoreOfPart(part) == store)
      LF_RETURN_IF_ERROR(RenameFlushed(part, unfinished));
  }
  LF_ASSIGN_OR_RETURN(parts, PartSetWriter::Open(path, store, part_count, bytes));
  LF_ASSIGN_OR_RETURN(insert_ranges,
                      database->Prepare("insert or replace into ranges values (?, ?)"));
  return {};
}

// Opens a shard for writing, and makes it if it does not exist.
Result<void> PackedStoreWriter::State::OpenShard(int number) {
  if (number > kMostShards)
    return OutputError(
        fmt::format("{}: the store needs more than {} shards, the largest number allowed: give a "
                    "larger {{shard_size}}",
                    path.string(), kMostShards));
  blobs.reset();
  shard.reset();
  const fs::path shard_path = ShardPath(path, number);
  LF_RETURN_IF_ERROR(CheckIsFree(shard_path, StoreOfShard(shard_path)));
  LF_ASSIGN_OR_RETURN(Database opened,
                      Database::OpenToAppend(UnfinishedPath(shard_path), kShardFormat));
  LF_ASSIGN_OR_RETURN(const bool has_tables, HasTables(&opened));
  if (!has_tables) {
    LF_RETURN_IF_ERROR(
        opened.Execute(fmt::format("begin; {}{}{}", kSettingsTable, kBlobsTable, kFrontsTable)));
    LF_RETURN_IF_ERROR(
        WriteSettings({{"store", store}, {"number", fmt::format("{}", number)}}, &opened));
    LF_RETURN_IF_ERROR(opened.Execute("commit"));
  }
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(opened, kShardFormat.name));
  if (settings.Text("store") != store)
    return InputError(fmt::format(
        "{}: this shard belongs to another packed store than the unfinished one: remove this file",
        UnfinishedPath(shard_path).string()));
  shard = std::move(opened);
  shard_count = number;
  return {};
}

// Begins a batch unless one is open, and counts one more image or plane in it.
Result<void> PackedStoreWriter::State::BeginInBatch() {
  if (batch_size++ > 0) return {};
  LF_RETURN_IF_ERROR(database->Execute("begin"));
  if (shard) LF_RETURN_IF_ERROR(shard->Execute("begin"));
  batch_begin = std::chrono::steady_clock::now();
  return {};
}

// Begins a new shard if this number of bytes does not fit into the last one.
Result<void> PackedStoreWriter::State::MakeRoom(uint64_t bytes) {
  if (shard_bytes == 0) return {};
  if (shard_count > 0 && (bytes_in_shard == 0 || bytes_in_shard + bytes <= shard_bytes)) return {};
  LF_RETURN_IF_ERROR(CommitBatch());
  LF_RETURN_IF_ERROR(OpenShard(shard_count + 1));
  bytes_in_shard = 0;
  return {};
}

bool PackedStoreWriter::State::IsAddable(LfImageId id, const CodedImage& image) const {
  if (id.value >= has.size() || has[id.value] || image.rect.empty() || image.code.empty())
    return false;
  if (image.references.empty()) return true;
  return references && image.values != StoredValues::kFile && image.front_ends.empty() &&
         std::all_of(image.references.begin(), image.references.end(),
                     [&](LfImageId of) { return of.value < has.size() && has[of.value]; }) &&
         references->Allows(image.references);
}

Result<void> PackedStoreWriter::State::Insert(LfImageId id, const CodedImage& image) {
  LF_CHECK(IsAddable(id, image));
  LF_RETURN_IF_ERROR(BeginInBatch());
  LF_RETURN_IF_ERROR(parts ? InsertRanges(id, image) : InsertBlob(id, image));
  insert_code->Bind(0, int64_t{id.value}).Bind(1, int64_t{shard ? shard_count : 0});
  insert_code->Bind(2, std::string_view(kKindNames[static_cast<int>(image.values)]));
  insert_code->Bind(3, int64_t{image.rect.x_begin}).Bind(4, int64_t{image.rect.y_begin});
  insert_code->Bind(5, int64_t{image.rect.x_end}).Bind(6, int64_t{image.rect.y_end});
  const uint64_t bytes = BytesInStore(image);
  insert_code->Bind(7, static_cast<int64_t>(bytes));
  insert_code->Bind(8, static_cast<int64_t>(image.source_bytes));
  LF_RETURN_IF_ERROR(insert_code->Run());
  if (!image.references.empty()) LF_RETURN_IF_ERROR(references->Insert(id, image.references));
  bytes_in_shard += bytes;
  has[id.value] = true;
  return {};
}

Result<void> PackedStoreWriter::State::InsertRanges(LfImageId id, const CodedImage& image) {
  LF_ASSIGN_OR_RETURN(const ImageRanges ranges, parts->Add(image));
  insert_ranges->Bind(0, int64_t{id.value}).BindBlob(1, TextOfRanges(ranges));
  return insert_ranges->Run();
}

Result<void> PackedStoreWriter::State::InsertBlob(LfImageId id, const CodedImage& image) {
  if (!blobs) {
    LF_ASSIGN_OR_RETURN(blobs, BlobTable::Open(shard ? &*shard : &*database));
  }
  return blobs->Insert(id, image);
}

Result<void> PackedStoreWriter::State::AddPlane(LfImageId id, PlaneKind kind, PlaneSize size,
                                                std::string_view code) {
  const std::lock_guard lock_of_state(mutex);
  if (failed) return *failed;
  LF_CHECK(planes && planes->Fits(id, kind, size) && !planes->Has(id, kind));
  const auto insert = [&]() -> Result<void> {
    LF_RETURN_IF_ERROR(BeginInBatch());
    LF_RETURN_IF_ERROR(planes->Insert(id, kind, code));
    return CommitIfDue();
  };
  return Kept(insert());
}

// Commits the batch if it is large or old enough.
Result<void> PackedStoreWriter::State::CommitIfDue() {
  if (batch_size < kImagesPerBatch && std::chrono::steady_clock::now() - batch_begin < kBatchAge)
    return {};
  return CommitBatch();
}

// Commits the encoded images in the shard or the parts before the rows of the store that refer to
// them.
Result<void> PackedStoreWriter::State::CommitBatch() {
  if (batch_size == 0) return {};
  batch_size = 0;
  if (shard) {
    LF_RETURN_IF_ERROR(shard->Execute("commit"));
    LF_RETURN_IF_ERROR(database->Execute(
        fmt::format("update settings set value = '{}' where key = 'shards'", shard_count)));
  }
  if (parts) {
    LF_RETURN_IF_ERROR(parts->Flush());
    LF_RETURN_IF_ERROR(WritePartBytes());
  }
  return database->Execute("commit");
}

Result<void> PackedStoreWriter::State::WritePartBytes() {
  return database->Execute(fmt::format("update settings set value = '{}' where key = '{}'",
                                       parts->TextOfBytes(), kPartBytesKey));
}

Result<void> PackedStoreWriter::State::FinishFiles() {
  const size_t planned_parts = parts ? parts->count() : 0;
  if (parts) {
    LF_RETURN_IF_ERROR(parts->Flush());
    parts->DropUnused();
    LF_RETURN_IF_ERROR(WritePartBytes());
  }
  const size_t part_count = parts ? parts->count() : 0;
  LF_RETURN_IF_ERROR(database->Execute(
      fmt::format("update settings set value = '{}' where key = 'state'", kComplete)));
  Close();
  std::error_code ignored;
  for (size_t n = 0; n < planned_parts; ++n) {
    const fs::path part = PartPath(path, n);
    if (n >= part_count) {
      fs::remove(UnfinishedPath(part), ignored);
      continue;
    }
    LF_RETURN_IF_ERROR(CheckIsFree(part, StoreOfPart(part)));
    LF_RETURN_IF_ERROR(RenameFlushed(UnfinishedPath(part), part));
  }
  for (int n = 1; n <= shard_count; ++n) {
    const fs::path of_shard = ShardPath(path, n);
    LF_RETURN_IF_ERROR(CheckIsFree(of_shard, StoreOfShard(of_shard)));
    LF_RETURN_IF_ERROR(RenameFlushed(UnfinishedPath(ShardPath(path, n)), ShardPath(path, n)));
  }
  LF_RETURN_IF_ERROR(RenameFlushed(UnfinishedPath(path), path));
  // Removes the shards and parts of the replaced store whose numbers are beyond the new ones.
  if (replaced.empty()) return {};
  for (size_t n = part_count; n < kMostParts; ++n)
    if (StoreOfPart(PartPath(path, n)) == replaced) fs::remove(PartPath(path, n), ignored);
  for (int n = shard_count + 1; n <= kMostShards && StoreOfShard(ShardPath(path, n)) == replaced;
       ++n)
    fs::remove(ShardPath(path, n), ignored);
  return {};
}

PackedStoreWriter::PackedStoreWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
PackedStoreWriter::PackedStoreWriter(PackedStoreWriter&&) noexcept = default;
PackedStoreWriter& PackedStoreWriter::operator=(PackedStoreWriter&&) noexcept = default;
PackedStoreWriter::~PackedStoreWriter() = default;

Result<PackedStoreWriter> PackedStoreWriter::Open(const fs::path& path,
                                                  const LightField& light_field,
                                                  const PackedStorePlan& plan,
                                                  std::optional<FileLock> lock) {
  LF_CHECK(light_field.size() > 0);
  LF_RETURN_IF_ERROR(CheckPlan(light_field, plan));
  auto state = std::make_unique<State>();
  state->path = path;
  if (lock) {
    state->lock = std::move(lock);
  } else {
    LF_ASSIGN_OR_RETURN(state->lock, Lock(path));
  }
  // If the file of an unfinished store is missing, its shards may be left.
  if (!IsUnfinished(path)) RemoveUnfinishedFiles(path);
  state->shard_bytes = plan.shard_bytes;
  state->replaced = StoreIdOf(path);
  state->has.resize(light_field.size());
  state->source_bytes.resize(light_field.size());
  // Checks the names of the first shard and of the parts now, and not after all work is done.
  if (!IsUnfinished(path)) {
    const fs::path first_shard = ShardPath(path, 1);
    if (plan.shard_bytes > 0)
      LF_RETURN_IF_ERROR(state->CheckIsFree(first_shard, StoreOfShard(first_shard)));
    for (size_t n = 0; n < plan.part_count; ++n)
      LF_RETURN_IF_ERROR(state->CheckIsFree(PartPath(path, n), StoreOfPart(PartPath(path, n))));
  }
  LF_ASSIGN_OR_RETURN(Database database,
                      Database::OpenToAppend(UnfinishedPath(path), kStoreFormat));
  LF_ASSIGN_OR_RETURN(const bool has_tables, HasTables(&database));
  if (!has_tables) LF_RETURN_IF_ERROR(MakeStoreTables(light_field, plan, &database));
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(database, kStoreFormat.name));
  if (const auto difference = FirstDifference(settings, light_field, plan, false))
    return UsageError(
        fmt::format("{}: the unfinished store was begun with {}: give the options and files it was "
                    "begun with, give another name, or start it again with {{overwrite}}",
                    path.string(), *difference));
  state->database = std::move(database);
  LF_RETURN_IF_ERROR(state->Read(settings));
  LF_ASSIGN_OR_RETURN(
      state->insert_code,
      state->database->Prepare("insert into codes values (?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  if (plan.densified) {
    LF_ASSIGN_OR_RETURN(
        state->planes,
        PlaneTable::Open(settings, light_field, plan.densified->plane_divisor, &*state->database));
  }
  if (plan.is_predicted) {
    LF_ASSIGN_OR_RETURN(state->references,
                        ReferenceRows::Open(settings, state->has, &*state->database));
  }
  if (plan.part_count > 0) LF_RETURN_IF_ERROR(state->OpenParts(settings));
  if (state->shard_count > 0) {
    LF_RETURN_IF_ERROR(state->TakeShardsBack());
    LF_RETURN_IF_ERROR(state->OpenShard(state->shard_count));
  }
  return PackedStoreWriter(std::move(state));
}

Result<PackedStoreWriter> PackedStoreWriter::Create(const fs::path& path,
                                                    const LightField& light_field,
                                                    const PackedStorePlan& plan,
                                                    std::optional<FileLock> lock) {
  if (IsUnfinished(path))
    return UsageError(
        fmt::format("{}: an unfinished store of this name exists: continue it with {{resume}}, or "
                    "start it again with {{overwrite}}",
                    UnfinishedPath(path).string()));
  return Open(path, light_field, plan, std::move(lock));
}

Result<PackedStoreWriter> PackedStoreWriter::Resume(const fs::path& path,
                                                    const LightField& light_field,
                                                    const PackedStorePlan& plan,
                                                    std::optional<FileLock> lock) {
  return Open(path, light_field, plan, std::move(lock));
}

Result<FileLock> PackedStoreWriter::Lock(const fs::path& path) {
  return FileLock::Take(fs::path(path) += ".lock");
}

bool PackedStoreWriter::IsUnfinished(const fs::path& path) {
  std::error_code error;
  return fs::exists(UnfinishedPath(path), error);
}

void PackedStoreWriter::RemoveUnfinished(const fs::path& path, const FileLock& /*lock*/) {
  RemoveUnfinishedFiles(path);
}

uint64_t PackedStoreWriter::SourceBytes(LfImageId id) const {
  return state_->source_bytes[id.value];
}

bool PackedStoreWriter::Has(LfImageId id) const {
  const std::lock_guard lock(state_->mutex);
  return state_->has[id.value];
}

Result<void> PackedStoreWriter::Add(LfImageId id, const CodedImage& image) {
  const std::lock_guard lock(state_->mutex);
  State& state = *state_;
  if (state.failed) return *state.failed;
  const auto insert = [&]() -> Result<void> {
    LF_RETURN_IF_ERROR(state.MakeRoom(BytesInStore(image)));
    LF_RETURN_IF_ERROR(state.Insert(id, image));
    return state.CommitIfDue();
  };
  return state.Kept(insert());
}

Result<void> PackedStoreWriter::AddGroup(std::span<const GroupedImage> images) {
  const std::lock_guard lock(state_->mutex);
  State& state = *state_;
  if (state.failed) return *state.failed;
  uint64_t bytes = 0;
  for (const GroupedImage& grouped : images) bytes += BytesInStore(grouped.image);
  const auto insert = [&]() -> Result<void> {
    LF_RETURN_IF_ERROR(state.MakeRoom(bytes));
    for (const GroupedImage& grouped : images)
      LF_RETURN_IF_ERROR(state.Insert(grouped.id, grouped.image));
    return state.CommitIfDue();
  };
  return state.Kept(insert());
}

bool PackedStoreWriter::HasPlane(LfImageId id, PlaneKind kind) const {
  const std::lock_guard lock(state_->mutex);
  LF_CHECK(state_->planes);
  return state_->planes->Has(id, kind);
}

Result<void> PackedStoreWriter::AddPlane(LfImageId id, PlaneKind kind,
                                         const Image<uint16_t>& plane) {
  LF_CHECK(kind != PlaneKind::kTrust);
  return state_->AddPlane(id, kind, {plane.width(), plane.height()}, EncodePlane(plane));
}

Result<void> PackedStoreWriter::AddTrust(LfImageId id, const Image<uint8_t>& trust) {
  return state_->AddPlane(id, PlaneKind::kTrust, {trust.width(), trust.height()},
                          EncodeTrust(trust));
}

Result<Image<uint16_t>> PackedStoreWriter::ReadPlane(LfImageId id, PlaneKind kind) const {
  std::unique_lock lock(state_->mutex);
  LF_ASSIGN_OR_RETURN(const StoredPlane plane, state_->planes->Read(id, kind));
  lock.unlock();
  return DecodePlane(plane);
}

Result<void> PackedStoreWriter::DropPlanes(PlaneKind kind) {
  const std::lock_guard lock(state_->mutex);
  if (state_->failed) return *state_->failed;
  LF_RETURN_IF_ERROR(state_->Kept(state_->CommitBatch()));
  return state_->Kept(state_->planes->Drop(kind));
}

Result<void> PackedStoreWriter::Commit() {
  const std::lock_guard lock(state_->mutex);
  if (state_->failed) return *state_->failed;
  return state_->Kept(state_->CommitBatch());
}

Result<void> PackedStoreWriter::Finish() {
  LF_RETURN_IF_ERROR(Commit());
  const std::lock_guard lock(state_->mutex);
  LF_RETURN_IF_ERROR(state_->FinishFiles());
  state_->lock->Remove();
  return {};
}

void PackedStoreWriter::Abandon() {
  const std::lock_guard lock(state_->mutex);
  state_->Close();
  RemoveUnfinishedFiles(state_->path);
  state_->lock->Remove();
}

Result<void> CheckIsOfPlan(const fs::path& path, const LightField& light_field,
                           const PackedStorePlan& plan, bool any_shards) {
  LF_ASSIGN_OR_RETURN(Database database, OpenStoreDatabase(path));
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(database, kStoreFormat.name));
  if (const auto difference = FirstDifference(settings, light_field, plan, any_shards))
    return InputError(
        fmt::format("{}: this packed store was made with {}: give the light field and options that "
                    "it was made with",
                    path.string(), *difference));
  return {};
}

}  // namespace lf
