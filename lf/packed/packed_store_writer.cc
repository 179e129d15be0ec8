#include "lf/packed/packed_store_writer.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <random>
#include <system_error>
#include <utility>

#include "lf/calibration_tables/calibration_tables.h"
#include "lf/calibration_tables/stored_numbers.h"
#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/hash.h"
#include "lf/packed/packed_format.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kImagesPerBatch = 64;
constexpr std::chrono::seconds kBatchAge{2};

// By which shards are known; two stores of the same images differ in it.
std::string NewStoreId() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

std::string HashOfIds(const std::vector<uint32_t>& ids) {
  return ids.empty() ? std::string()
                     : fmt::format("{:016x}", HashBytes(BytesOf(std::span<const uint32_t>(ids))));
}

std::string TextOf(const std::optional<DisplayLevels>& levels) {
  return levels ? fmt::format("{} {}", levels->black, levels->white) : std::string();
}

// What a store must have in common with the one that it goes on.
SettingList SettingsOfPlan(const LightField& light_field, const PackedStorePlan& plan) {
  const LightFieldIdentity images = IdentityOf(light_field);
  SettingList settings = {{"light_field.images", fmt::format("{}", plan.whole.image_count)},
                          {"light_field.names", plan.whole.names},
                          {"light_field.calibration", plan.whole.calibration},
                          {"images", fmt::format("{}", images.image_count)},
                          {"images.names", images.names},
                          {"images.calibration", images.calibration},
                          {"images.whole_ids", HashOfIds(plan.whole_ids)},
                          {"codec", plan.codec},
                          {"display_levels", TextOf(plan.display_levels)},
                          {"shard_bytes", fmt::format("{}", plan.shard_bytes)}};
  const SettingList pixels = SettingsOfPixels(light_field);
  settings.insert(settings.end(), pixels.begin(), pixels.end());
  return settings;
}

Result<void> WriteImages(const LightField& light_field, const PackedStorePlan& plan,
                         Database* database) {
  LF_CHECK(plan.whole_ids.empty() || plan.whole_ids.size() == light_field.size());
  LF_ASSIGN_OR_RETURN(
      Statement insert,
      database->Prepare("insert into lf_images values (?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    insert.Bind(0, int64_t{i}).Bind(1, int64_t{plan.whole_ids.empty() ? i : plan.whole_ids[i]});
    insert.Bind(2, std::string_view(light_field.image_names[i]));
    BindCamera(light_field, LfImageId{i}, 3, &insert);
    LF_RETURN_IF_ERROR(insert.Run());
  }
  return {};
}

Result<bool> HasTables(Database* database) {
  LF_ASSIGN_OR_RETURN(
      Statement select,
      database->Prepare("select 1 from sqlite_master where name = 'settings' and type = 'table'"));
  return select.Step();
}

// All or nothing, also for one who is killed here.
Result<void> MakeTables(const LightField& light_field, const PackedStorePlan& plan,
                        Database* database) {
  LF_RETURN_IF_ERROR(
      database->Execute(fmt::format("begin; {}{}{}{}", kSettingsTable, kIntrinsicsTable,
                                    kStoreTables, plan.shard_bytes > 0 ? "" : kBlobsTable)));
  LF_RETURN_IF_ERROR(WriteSettings({{"written_by", "lfrendertools " + plan.version},
                                    {"light_field", plan.source},
                                    {"state", kUnfinished},
                                    {"store", NewStoreId()},
                                    {"shards", "0"}},
                                   database));
  LF_RETURN_IF_ERROR(WriteSettings(SettingsOfPlan(light_field, plan), database));
  LF_RETURN_IF_ERROR(WriteIntrinsics(light_field.intrinsics, database));
  LF_RETURN_IF_ERROR(WriteImages(light_field, plan, database));
  return database->Execute("commit");
}

Result<void> CheckSame(const Settings& settings, const LightField& light_field,
                       const PackedStorePlan& plan, const fs::path& path) {
  for (const auto& [key, value] : SettingsOfPlan(light_field, plan))
    if (settings.Text(key) != value)
      return UsageError(fmt::format(
          "{}: the unfinished store was made with {} {}, this call has {}: give the same, or "
          "another name, or begin anew",
          path.string(), key, settings.Text(key).empty() ? "(none)" : settings.Text(key),
          value.empty() ? "(none)" : value));
  return {};
}

void RemoveWithJournal(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
  fs::remove(fs::path(path) += "-journal", ignored);
}

void RemoveUnfinishedFiles(const fs::path& path) {
  RemoveWithJournal(UnfinishedPath(path));
  std::error_code error;
  for (int n = 1; n <= kMostShards && fs::exists(UnfinishedPath(ShardPath(path, n)), error); ++n)
    RemoveWithJournal(UnfinishedPath(ShardPath(path, n)));
}

// The id of the store that a shard belongs to; none if it is no shard.
std::optional<std::string> StoreOfShard(const fs::path& path) {
  Result<Database> database = Database::Open(path, kShardFormat);
  if (!database) return std::nullopt;
  const Result<Settings> settings = Settings::Read(*database, kShardFormat.name);
  return settings ? std::optional(settings->Text("store")) : std::nullopt;
}

Result<FileLock> Lock(const fs::path& path) { return FileLock::Take(fs::path(path) += ".lock"); }

}  // namespace

struct PackedStoreWriter::State {
  fs::path path;
  std::optional<FileLock> lock;
  uint64_t shard_bytes = 0;
  std::string store;

  std::mutex mutex;  // of all below
  std::vector<bool> has;
  size_t image_count = 0;
  std::optional<Database> database;
  std::optional<Statement> insert_code;
  int shard_count = 0;
  uint64_t bytes_in_shard = 0;
  std::optional<Database> shard;  // the last one
  std::optional<Statement> insert_blob;
  size_t batch_size = 0;
  std::chrono::steady_clock::time_point batch_begin;
  std::optional<Error> failed;

  ~State() {
    // Statements before databases, and the lock last.
    Close();
    if (lock) lock->Remove();
  }
  void Close() {
    insert_blob.reset();
    shard.reset();
    insert_code.reset();
    database.reset();
  }

  Result<void> Read(const Settings& settings);
  Result<void> TakeShardsBack() const;
  Result<void> OpenShard(int number);
  Result<void> Insert(LfImageId id, const CodedImage& image);
  Result<void> CommitBatch();
  Result<void> FinishFiles();
  Error Failed(Error error) {
    failed = error;
    return error;
  }
};

// Of a store that goes on: what it has.
Result<void> PackedStoreWriter::State::Read(const Settings& settings) {
  store = settings.Text("store");
  LF_ASSIGN_OR_RETURN(const double shards, settings.Number("shards", 0, kMostShards));
  shard_count = static_cast<int>(shards);
  return ForEachRow(*database, "select id, shard, bytes from codes",
                    [&](const Statement& row) -> Result<void> {
                      LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0));
                      LF_ASSIGN_OR_RETURN(const int64_t of_shard, row.Integer(1));
                      LF_ASSIGN_OR_RETURN(const int64_t bytes, row.Integer(2));
                      if (id < 0 || static_cast<size_t>(id) >= has.size())
                        return settings.Damaged(fmt::format("a code of LF image {}", id));
                      has[static_cast<size_t>(id)] = true;
                      ++image_count;
                      if (of_shard == shard_count) bytes_in_shard += static_cast<uint64_t>(bytes);
                      return {};
                    });
}

// The shards of a store that was killed while they got their names.
Result<void> PackedStoreWriter::State::TakeShardsBack() const {
  std::error_code error;
  for (int n = 1; n <= shard_count; ++n) {
    const fs::path shard_path = ShardPath(path, n);
    if (fs::exists(UnfinishedPath(shard_path), error)) continue;
    if (StoreOfShard(shard_path) != store)
      return InputError(
          fmt::format("{}: is missing: begin the store anew", UnfinishedPath(shard_path).string()));
    LF_RETURN_IF_ERROR(RenameFlushed(shard_path, UnfinishedPath(shard_path)));
  }
  return {};
}

// Makes it if it is not there.
Result<void> PackedStoreWriter::State::OpenShard(int number) {
  if (number > kMostShards)
    return OutputError(
        fmt::format("{}: has {} shards: make them larger", path.string(), kMostShards));
  insert_blob.reset();
  shard.reset();
  const fs::path shard_path = ShardPath(path, number);
  if (IsPackedStore(shard_path))
    return OutputError(
        fmt::format("{}: is a store of its own, in the way of a shard: give another "
                    "name",
                    shard_path.string()));
  LF_ASSIGN_OR_RETURN(Database opened,
                      Database::OpenToAppend(UnfinishedPath(shard_path), kShardFormat));
  LF_ASSIGN_OR_RETURN(const bool has_tables, HasTables(&opened));
  if (!has_tables) {
    LF_RETURN_IF_ERROR(opened.Execute(fmt::format("begin; {}{}", kSettingsTable, kBlobsTable)));
    LF_RETURN_IF_ERROR(
        WriteSettings({{"store", store}, {"number", fmt::format("{}", number)}}, &opened));
    LF_RETURN_IF_ERROR(opened.Execute("commit"));
  }
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(opened, kShardFormat.name));
  if (settings.Text("store") != store)
    return InputError(fmt::format("{}: belongs to another packed store: remove it",
                                  UnfinishedPath(shard_path).string()));
  shard = std::move(opened);
  shard_count = number;
  return {};
}

Result<void> PackedStoreWriter::State::Insert(LfImageId id, const CodedImage& image) {
  const uint64_t bytes = image.code.size() + image.mask.size();
  if (shard_bytes > 0 &&
      (shard_count == 0 || (bytes_in_shard > 0 && bytes_in_shard + bytes > shard_bytes))) {
    LF_RETURN_IF_ERROR(CommitBatch());
    LF_RETURN_IF_ERROR(OpenShard(shard_count + 1));
    bytes_in_shard = 0;
  }
  if (batch_size == 0) {
    LF_RETURN_IF_ERROR(database->Execute("begin"));
    if (shard) LF_RETURN_IF_ERROR(shard->Execute("begin"));
    batch_begin = std::chrono::steady_clock::now();
  }
  ++batch_size;
  if (!insert_blob) {
    // In place of one that was committed there, when the program ended before its row here was.
    LF_ASSIGN_OR_RETURN(Statement prepared, (shard ? *shard : *database)
                                                .Prepare("insert or replace into blobs values "
                                                         "(?, ?, ?)"));
    insert_blob = std::move(prepared);
  }
  insert_blob->Bind(0, int64_t{id.value}).BindBlob(1, image.code);
  if (image.mask.empty())
    insert_blob->BindNull(2);
  else
    insert_blob->BindBlob(2, image.mask);
  LF_RETURN_IF_ERROR(insert_blob->Run());
  insert_code->Bind(0, int64_t{id.value}).Bind(1, int64_t{shard ? shard_count : 0});
  insert_code->Bind(2, std::string_view(kKindNames[static_cast<int>(image.values)]));
  insert_code->Bind(3, int64_t{image.rect.x_begin}).Bind(4, int64_t{image.rect.y_begin});
  insert_code->Bind(5, int64_t{image.rect.x_end}).Bind(6, int64_t{image.rect.y_end});
  insert_code->Bind(7, static_cast<int64_t>(bytes));
  insert_code->Bind(8, static_cast<int64_t>(image.source_bytes));
  LF_RETURN_IF_ERROR(insert_code->Run());
  bytes_in_shard += bytes;
  return {};
}

// Blobs before the rows that tell of them.
Result<void> PackedStoreWriter::State::CommitBatch() {
  if (batch_size == 0) return {};
  batch_size = 0;
  if (shard) {
    LF_RETURN_IF_ERROR(shard->Execute("commit"));
    LF_RETURN_IF_ERROR(database->Execute(
        fmt::format("update settings set value = '{}' where key = 'shards'", shard_count)));
  }
  return database->Execute("commit");
}

Result<void> PackedStoreWriter::State::FinishFiles() {
  LF_RETURN_IF_ERROR(database->Execute(
      fmt::format("update settings set value = '{}' where key = 'state'", kComplete)));
  Close();
  for (int n = 1; n <= shard_count; ++n)
    LF_RETURN_IF_ERROR(RenameFlushed(UnfinishedPath(ShardPath(path, n)), ShardPath(path, n)));
  LF_RETURN_IF_ERROR(RenameFlushed(UnfinishedPath(path), path));
  // What a larger store of the same name had.
  std::error_code ignored;
  for (int n = shard_count + 1; n <= kMostShards && StoreOfShard(ShardPath(path, n)); ++n)
    fs::remove(ShardPath(path, n), ignored);
  return {};
}

PackedStoreWriter::PackedStoreWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
PackedStoreWriter::PackedStoreWriter(PackedStoreWriter&&) noexcept = default;
PackedStoreWriter& PackedStoreWriter::operator=(PackedStoreWriter&&) noexcept = default;
PackedStoreWriter::~PackedStoreWriter() = default;

Result<PackedStoreWriter> PackedStoreWriter::Open(const fs::path& path,
                                                  const LightField& light_field,
                                                  const PackedStorePlan& plan) {
  LF_CHECK(light_field.size() > 0);
  auto state = std::make_unique<State>();
  state->path = path;
  LF_ASSIGN_OR_RETURN(state->lock, Lock(path));
  if (!IsUnfinished(path)) RemoveUnfinishedFiles(path);  // shards alone
  state->shard_bytes = plan.shard_bytes;
  state->has.resize(light_field.size());
  LF_ASSIGN_OR_RETURN(Database database,
                      Database::OpenToAppend(UnfinishedPath(path), kStoreFormat));
  LF_ASSIGN_OR_RETURN(const bool has_tables, HasTables(&database));
  if (!has_tables) LF_RETURN_IF_ERROR(MakeTables(light_field, plan, &database));
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(database, kStoreFormat.name));
  LF_RETURN_IF_ERROR(CheckSame(settings, light_field, plan, path));
  state->database = std::move(database);
  LF_RETURN_IF_ERROR(state->Read(settings));
  LF_ASSIGN_OR_RETURN(
      state->insert_code,
      state->database->Prepare("insert into codes values (?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  if (state->shard_count > 0) {
    LF_RETURN_IF_ERROR(state->TakeShardsBack());
    LF_RETURN_IF_ERROR(state->OpenShard(state->shard_count));
  }
  return PackedStoreWriter(std::move(state));
}

Result<PackedStoreWriter> PackedStoreWriter::Create(const fs::path& path,
                                                    const LightField& light_field,
                                                    const PackedStorePlan& plan) {
  if (IsUnfinished(path))
    return UsageError(
        fmt::format("{}: there is an unfinished store of this name: go on with it, "
                    "or begin anew",
                    UnfinishedPath(path).string()));
  return Open(path, light_field, plan);
}

Result<PackedStoreWriter> PackedStoreWriter::Resume(const fs::path& path,
                                                    const LightField& light_field,
                                                    const PackedStorePlan& plan) {
  return Open(path, light_field, plan);
}

bool PackedStoreWriter::IsUnfinished(const fs::path& path) {
  std::error_code error;
  return fs::exists(UnfinishedPath(path), error);
}

Result<void> PackedStoreWriter::RemoveUnfinished(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(FileLock lock, Lock(path));
  RemoveUnfinishedFiles(path);
  lock.Remove();
  return {};
}

bool PackedStoreWriter::Has(LfImageId id) const {
  const std::lock_guard lock(state_->mutex);
  return state_->has[id.value];
}

size_t PackedStoreWriter::image_count() const {
  const std::lock_guard lock(state_->mutex);
  return state_->image_count;
}

Result<void> PackedStoreWriter::Add(LfImageId id, const CodedImage& image) {
  const std::lock_guard lock(state_->mutex);
  State& state = *state_;
  if (state.failed) return *state.failed;
  LF_CHECK(id.value < state.has.size() && !state.has[id.value]);
  LF_CHECK(!image.rect.empty() && !image.code.empty());
  if (const Result<void> inserted = state.Insert(id, image); !inserted)
    return state.Failed(inserted.error());
  state.has[id.value] = true;
  ++state.image_count;
  if (state.batch_size < kImagesPerBatch &&
      std::chrono::steady_clock::now() - state.batch_begin < kBatchAge)
    return {};
  if (const Result<void> committed = state.CommitBatch(); !committed)
    return state.Failed(committed.error());
  return {};
}

Result<void> PackedStoreWriter::Commit() {
  const std::lock_guard lock(state_->mutex);
  if (state_->failed) return *state_->failed;
  if (const Result<void> committed = state_->CommitBatch(); !committed)
    return state_->Failed(committed.error());
  return {};
}

Result<void> PackedStoreWriter::Finish() {
  LF_RETURN_IF_ERROR(Commit());
  const std::lock_guard lock(state_->mutex);
  LF_RETURN_IF_ERROR(state_->FinishFiles());
  state_->lock->Remove();
  return {};
}

}  // namespace lf
