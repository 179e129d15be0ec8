// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/packed_store_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <system_error>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/light_field/model/value_hasher.h"
#include "lf/storage/packed/code_fronts.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/part_file.h"
#include "lf/storage/packed/part_set.h"
#include "lf/storage/packed/plan_settings.h"
#include "lf/storage/packed/plane_table.h"
#include "lf/storage/packed/reference_rows.h"
#include "lf/storage/packed/reference_table.h"
#include "lf/storage/packed/store_codes.h"
#include "lf/storage/tables/calibration_tables.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostOpenShards = 8;  // most shards that one PackedCodeReader keeps open

Result<LightFieldIdentity> WholeIdentity(const Settings& settings) {
  LF_ASSIGN_OR_RETURN(const uint64_t count, settings.Whole("light_field.images"));
  return LightFieldIdentity{count, settings.Text("light_field.names"),
                            settings.Text("light_field.calibration")};
}

// Sets LfCamera::is_virtual, and checks that exactly the recorded LF images have a number in the
// whole light field.
Result<void> MarkVirtual(OpenedStore* store, PackedStoreFacts* facts) {
  LightField& light_field = facts->light_field;
  LF_ASSIGN_OR_RETURN(const std::vector<bool> is_virtual,
                      ReadMarks(store, kVirtualTable, light_field.size()));
  for (size_t i = 0; i < light_field.size(); ++i) {
    light_field.cameras[i].is_virtual = !is_virtual.empty() && is_virtual[i];
    if (light_field.cameras[i].is_virtual != (facts->whole_ids[i] == kNoWholeId))
      return store->settings.Damaged(
          fmt::format("LF image {} is both recorded and virtual, or neither", i));
  }
  return {};
}

Result<void> ReadImages(OpenedStore* store, PackedStoreFacts* facts) {
  LightField& light_field = facts->light_field;
  LF_RETURN_IF_ERROR(ForEachRow(
      store->database,
      "select id, whole_id, name, intrinsics, gain, pose from lf_images order by id",
      [&](const Statement& row) -> Result<void> {
        const auto next = static_cast<int64_t>(light_field.size());
        LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0, 0, kMostImages));
        if (id != next) return store->settings.Damaged(fmt::format("LF image {} is missing", next));
        int64_t whole_id = kNoWholeId;
        if (!row.IsNull(1)) {
          LF_ASSIGN_OR_RETURN(whole_id, row.Integer(1, 0, kMostImages));
        }
        LF_ASSIGN_OR_RETURN(std::string name, row.Text(2));
        LF_ASSIGN_OR_RETURN(const LfCamera camera, ReadCamera(store->settings, row, 3, name,
                                                              light_field.intrinsics.size()));
        light_field.cameras.push_back(camera);
        light_field.image_names.push_back(std::move(name));
        facts->whole_ids.push_back(static_cast<uint32_t>(whole_id));
        return {};
      }));
  if (light_field.size() == 0) return store->settings.Damaged("it has no LF image");
  LF_RETURN_IF_ERROR(MarkVirtual(store, facts));
  const LightFieldIdentity images = IdentityInStore(light_field);
  if (store->settings.Text("images.names") != images.names)
    return store->settings.Damaged("the names of its LF images differ from the recorded checksum");
  if (store->settings.Text("images.calibration") != images.calibration)
    return store->settings.Damaged("its LF cameras differ from the recorded checksum");
  return {};
}

// Opens a shard for reading. kInput if it is not shard `number` of the store with the id `store`.
Result<Database> OpenShardOf(const fs::path& path, const std::string& store, int number) {
  LF_ASSIGN_OR_RETURN(Database database, OpenShardDatabase(ShardPath(path, number)));
  LF_ASSIGN_OR_RETURN(const Settings settings, Settings::Read(database, kShardFormat.name));
  if (settings.Text("store") != store || settings.Text("number") != fmt::format("{}", number))
    return database.Fault(
        fmt::format("is not shard {} of the packed store {}: copy all files of one store together, "
                    "and keep their names",
                    number, path.string()));
  return database;
}

// An open file with the table of encoded images (a shard, or a store without shards), and the SQL
// commands that read one encoded image and its fronts.
struct OpenBlobs {
  int shard = 0;
  Database database;
  Statement select;
  std::optional<Statement> select_fronts;  // nullopt if an earlier build made the file
};

Result<OpenBlobs> WithSelect(int shard, Database database) {
  LF_ASSIGN_OR_RETURN(Statement select,
                      database.Prepare("select code, mask from blobs where id = ?"));
  std::optional<Statement> fronts;
  LF_ASSIGN_OR_RETURN(const bool has_fronts, HasTable(&database, kFrontsName));
  if (has_fronts) {
    LF_ASSIGN_OR_RETURN(fronts, database.Prepare("select fronts from fronts where id = ?"));
  }
  return OpenBlobs{shard, std::move(database), std::move(select), std::move(fronts)};
}

// Reads which parts of a store by resolution are there, and how many LF images they lack.
Result<void> ReadParts(OpenedStore* store, PackedStoreFacts* facts) {
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> found,
                      FoundPartBytes(store->database.name(), store->settings));
  if (found.empty()) return {};
  facts->part_count = found.size();
  facts->found_parts = static_cast<size_t>(
      std::count_if(found.begin(), found.end(), [](uint64_t n) { return n > 0; }));
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> stated, StatedPartBytes(store->settings));
  if (found == stated) return {};
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes, ReadCodes(store));
  const size_t missing = facts->part_count - facts->found_parts;
  facts->cut_count =
      static_cast<size_t>(std::count_if(codes.begin(), codes.end(), [&](const PackedCode& code) {
        return code.missing_parts > missing;
      }));
  return {};
}

}  // namespace

Result<OpenedStore> OpenComplete(const fs::path& path) {
  if (!StoreOfPart(path).empty())
    return InputError(fmt::format(
        "{}: is a part of a packed store: give the store's file, which has the same name without "
        "its last three characters before {}",
        path.string(), kStoreExtension));
  LF_ASSIGN_OR_RETURN(Database database, OpenStoreDatabase(path));
  LF_ASSIGN_OR_RETURN(Settings settings, Settings::Read(database, kStoreFormat.name));
  if (settings.Text("state") == kUnfinished)
    return database.Fault(fmt::format("is an unfinished packed store: finish it with {}",
                                      settings.Text(kDensifiedKey).empty()
                                          ? "{lfcompressor resume}"
                                          : "the program that densified it, and {resume}"));
  if (settings.Text("state") != kComplete) return settings.Wrong("state", "complete");
  return OpenedStore{std::move(database), std::move(settings)};
}

LightFieldIdentity IdentityInStore(const LightField& light_field) {
  LightFieldIdentity identity = IdentityOf(light_field);
  ValueHasher names;
  for (const std::string& name : light_field.image_names) names.Add(name);
  identity.names = names.Text();
  return identity;
}

bool IsPackedStore(const fs::path& path) {
  constexpr size_t kApplicationId = 68;  // position in an SQLite file; the highest byte comes first
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  char head[kApplicationId + 4] = {};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head, sizeof(head)) || !std::string_view(head, 15).starts_with("SQLite format 3"))
    return false;
  uint32_t id = 0;
  for (size_t i = kApplicationId; i < sizeof(head); ++i)
    id = id << 8 | static_cast<unsigned char>(head[i]);
  return id == kStoreFormat.application_id;
}

Result<bool> IsStoreThere(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, error))) return false;
  if (IsPackedStore(path)) return true;
  return UsageError(fmt::format(
      "{}: exists already, and is not a packed store: give another name, or remove the file",
      path.string()));
}

std::vector<fs::path> PackedStoresIn(const fs::path& folder) {
  std::vector<fs::path> stores;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == kStoreExtension && IsPackedStore(it->path()))
      stores.push_back(it->path());
  std::sort(stores.begin(), stores.end());
  return stores;
}

Result<PackedStoreFacts> ReadPackedStore(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  const Settings& settings = store.settings;
  PackedStoreFacts facts;
  LightField& light_field = facts.light_field;
  light_field.folder = path;
  LF_RETURN_IF_ERROR(ReadPixelSettings(settings, &light_field));
  LF_ASSIGN_OR_RETURN(facts.whole, WholeIdentity(settings));
  facts.source = settings.Text("light_field");
  facts.codec = settings.Text("codec");
  facts.written_by = settings.Text("written_by");
  LF_ASSIGN_OR_RETURN(facts.films, FilmsOf(settings));
  LF_ASSIGN_OR_RETURN(const double shards, settings.Number("shards", 0, kMostShards));
  facts.shard_count = static_cast<size_t>(shards);
  LF_ASSIGN_OR_RETURN(light_field.intrinsics, ReadIntrinsics(settings, &store.database));
  LF_RETURN_IF_ERROR(ReadImages(&store, &facts));
  LF_ASSIGN_OR_RETURN(facts.densified, ReadDensified(&store));
  LF_ASSIGN_OR_RETURN(const std::vector<bool> left_out,
                      ReadMarks(&store, kLeftOutName, light_field.size()));
  facts.left_out_count = static_cast<size_t>(std::count(left_out.begin(), left_out.end(), true));
  LF_RETURN_IF_ERROR(ReadParts(&store, &facts));
  LF_ASSIGN_OR_RETURN(const ReferenceTable references, ReadReferences(&store));
  facts.predicted_count = references.predicted_count();
  // Checks all shards now, so that a missing one is found before the first LF image is loaded.
  for (int number = 1; number <= static_cast<int>(facts.shard_count); ++number)
    LF_RETURN_IF_ERROR(OpenShardOf(path, settings.Text("store"), number));
  return facts;
}

std::vector<fs::path> FilesOf(const fs::path& path, const PackedStoreFacts& facts) {
  std::vector<fs::path> files = {path};
  for (size_t shard = 1; shard <= facts.shard_count; ++shard)
    files.push_back(ShardPath(path, static_cast<int>(shard)));
  for (size_t part = 0; part < facts.found_parts; ++part) files.push_back(PartPath(path, part));
  return files;
}

Result<DisplayLevels> ReadDisplayLevels(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const OpenedStore store, OpenComplete(path));
  LF_ASSIGN_OR_RETURN(const std::vector<double> levels,
                      store.settings.Numbers("display_levels", 2, 2));
  constexpr double kMost = 65535;
  if (!(-kMost <= levels[0] && levels[0] < levels[1] && levels[1] <= kMost))
    return store.settings.Wrong("display_levels", "black, and white above it");
  return DisplayLevels{levels[0], levels[1]};
}

Result<std::string> ReadCodecSettings(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const OpenedStore store, OpenComplete(path));
  return store.settings.Text("codec");
}

Result<std::optional<StoreFilms>> ReadStoreFilms(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const OpenedStore store, OpenComplete(path));
  return FilmsOf(store.settings);
}

Result<std::string> NameInStore(const fs::path& path, LfImageId id) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  LF_ASSIGN_OR_RETURN(Statement select,
                      store.database.Prepare("select name from lf_images where id = ?"));
  select.Bind(0, int64_t{id.value});
  LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
  if (!has_row) return store.settings.Damaged(fmt::format("LF image {} is missing", id.value));
  return select.Text(0);
}

Result<LightFieldIdentity> ReadWholeIdentity(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const OpenedStore store, OpenComplete(path));
  return WholeIdentity(store.settings);
}

struct PackedCodeReader::State {
  fs::path path;
  std::string store;  // the store's id
  int shard_count = 0;
  std::optional<PartSetReader> parts;  // set if the store is by resolution
  std::deque<OpenBlobs> open;          // open files, the most recently opened at the end
  Statement* last = nullptr;           // SQL command whose row Read() returned; null: none
  std::string front;                   // bytes that ReadFront() returned, or all bytes of parts
  std::string mask;                    // mask of parts

  Result<OpenBlobs> OpenShard(int number) const;
  Result<OpenBlobs*> At(int shard);
  Result<OpenBlobs*> FileOf(const PackedCode& code);
};

Result<OpenBlobs> PackedCodeReader::State::OpenShard(int number) const {
  LF_ASSIGN_OR_RETURN(Database database, OpenShardOf(path, store, number));
  return WithSelect(number, std::move(database));
}

Result<OpenBlobs*> PackedCodeReader::State::At(int shard) {
  const auto known = std::find_if(open.begin(), open.end(),
                                  [shard](const OpenBlobs& blobs) { return blobs.shard == shard; });
  if (known != open.end()) return &*known;
  LF_ASSIGN_OR_RETURN(OpenBlobs blobs, OpenShard(shard));
  if (open.size() == kMostOpenShards) open.pop_front();
  open.push_back(std::move(blobs));
  return &open.back();
}

PackedCodeReader::PackedCodeReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
PackedCodeReader::PackedCodeReader(PackedCodeReader&&) noexcept = default;
PackedCodeReader& PackedCodeReader::operator=(PackedCodeReader&&) noexcept = default;
PackedCodeReader::~PackedCodeReader() = default;

Result<PackedCodeReader> PackedCodeReader::Open(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  auto state = std::make_unique<State>();
  state->path = path;
  state->store = store.settings.Text("store");
  LF_ASSIGN_OR_RETURN(const double shards, store.settings.Number("shards", 0, kMostShards));
  state->shard_count = static_cast<int>(shards);
  LF_ASSIGN_OR_RETURN(const size_t part_count, PlannedParts(store.settings));
  if (part_count > 0) {
    LF_ASSIGN_OR_RETURN(state->parts,
                        PartSetReader::Open(path, std::move(store.database), store.settings));
  } else if (state->shard_count == 0) {
    LF_ASSIGN_OR_RETURN(OpenBlobs blobs, WithSelect(0, std::move(store.database)));
    state->open.push_back(std::move(blobs));
  }
  return PackedCodeReader(std::move(state));
}

Result<OpenBlobs*> PackedCodeReader::State::FileOf(const PackedCode& code) {
  // An open file is closed when others are opened, and its SQL command must end before.
  if (last) last->Reset();
  last = nullptr;
  if (shard_count > 0 ? code.shard == 0 : code.shard != 0)
    return InputError(
        fmt::format("{}: is a damaged {}: no shard contains LF image {}; copy or make it again",
                    path.string(), kStoreFormat.name, code.id));
  return At(code.shard);
}

Result<std::optional<PackedCodeReader::Front>> PackedCodeReader::ReadFront(const PackedCode& code,
                                                                           size_t left_out) {
  LF_CHECK(left_out > 0);
  if (state_->parts) {
    LF_ASSIGN_OR_RETURN(const ImageRanges ranges, state_->parts->RangesOf(code.id, code.bytes));
    const size_t front_count = ranges.pieces.size() - 1;
    if (front_count == 0) return std::optional<Front>();
    const size_t left_out_here = std::min(left_out, front_count);
    LF_RETURN_IF_ERROR(
        state_->parts->ReadCode(ranges, ranges.pieces.size() - left_out_here, &state_->front));
    return std::optional<Front>({state_->front, left_out_here});
  }
  LF_ASSIGN_OR_RETURN(OpenBlobs* const blobs, state_->FileOf(code));
  if (!blobs->select_fronts) return std::optional<Front>();
  Statement& select = *blobs->select_fronts;
  select.Bind(0, int64_t{code.id});
  LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
  if (!has_row) return std::optional<Front>();
  LF_ASSIGN_OR_RETURN(const std::string_view stated, select.Blob(0));
  const std::optional<std::vector<CodeFront>> fronts = FrontsOfCode(stated, code.bytes);
  select.Reset();
  const auto damaged = [&](std::string_view fault) {
    return blobs->database.Fault(
        fmt::format("is damaged: {} of LF image {}; copy or make it again", fault, code.id));
  };
  if (!fronts) return damaged("it states impossible lengths for the front");
  if (fronts->empty()) return std::optional<Front>();
  const size_t index = fronts->size() - std::min(left_out, fronts->size());
  LF_RETURN_IF_ERROR(
      blobs->database.ReadFront("blobs", "code", code.id, (*fronts)[index].bytes, &state_->front));
  if (HashBytes(state_->front) != (*fronts)[index].hash)
    return damaged("a wrong checksum in the encoded image");
  return std::optional<Front>({state_->front, fronts->size() - index});
}

Result<PackedCodeReader::Bytes> PackedCodeReader::Read(const PackedCode& code) {
  if (state_->parts) {
    LF_ASSIGN_OR_RETURN(const ImageRanges ranges, state_->parts->RangesOf(code.id, code.bytes));
    LF_RETURN_IF_ERROR(state_->parts->ReadCode(ranges, ranges.pieces.size(), &state_->front));
    LF_RETURN_IF_ERROR(state_->parts->ReadMask(ranges, &state_->mask));
    return Bytes{state_->front, state_->mask};
  }
  LF_ASSIGN_OR_RETURN(OpenBlobs* const blobs, state_->FileOf(code));
  Statement& select = blobs->select;
  select.Bind(0, int64_t{code.id});
  LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
  if (!has_row)
    return blobs->database.Fault(fmt::format(
        "is damaged: it lacks the encoded image of LF image {}; copy or make it again", code.id));
  state_->last = &select;
  Bytes bytes;
  LF_ASSIGN_OR_RETURN(bytes.code, select.Blob(0));
  if (!select.IsNull(1)) {
    LF_ASSIGN_OR_RETURN(bytes.mask, select.Blob(1));
  }
  return bytes;
}

}  // namespace lf
