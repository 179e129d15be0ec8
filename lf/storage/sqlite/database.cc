// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/sqlite/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "lf/core/hash.h"
#include "lf/core/version.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxBlobBytes = 1 << 30;

// SQLite's layer of the system for files that are written. It takes no locks, which some disks of
// clusters do not have: a file that is written has a temporary name, or its writer holds a
// FileLock.
constexpr const char* kWithoutLocks = "unix-none";

// One command may take kStepsOfSmallFile steps of SQLite's virtual machine, and kStepsOfByte more
// for each byte of the file. This is checked every kStepsBetweenLooks steps. Reading takes about 10
// steps for each value, and each value takes at least a byte of the file. A damaged file could take
// any number of steps, because a page may be listed as the child of several other pages.
constexpr int kStepsBetweenLooks = 1000;
constexpr int64_t kStepsOfSmallFile = 10'000'000, kStepsOfByte = 20;
constexpr size_t kHashBytes = sizeof(uint64_t);

// Returns the checksum of `bytes` as 8 bytes, the least significant first.
std::string HashText(std::string_view bytes) {
  std::string text(kHashBytes, '\0');
  const uint64_t hash = HashBytes(bytes);
  for (size_t i = 0; i < kHashBytes; ++i) text[i] = static_cast<char>(hash >> (8 * i) & 0xFF);
  return text;
}

// Returns the URI by which SQLite opens the file as immutable.
std::string UriOf(const fs::path& path) {
  std::string uri = "file:";
  for (const char c : fs::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#')
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return uri + "?immutable=1";
}

// Returns the length in bytes that the header of an SQLite file states for the file; 0 if it states
// no valid length (SQLite's "Database File Format", 1.3).
uintmax_t BytesOfPages(const fs::path& path) {
  constexpr size_t kHeadBytes = 100, kPageSize = 16, kChanges = 24, kPages = 28, kPagesValid = 92;
  char head[kHeadBytes] = {};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head, sizeof(head)) || !std::string_view(head, 15).starts_with("SQLite format 3"))
    return 0;
  const auto number = [&head](size_t begin, size_t bytes) {
    uintmax_t value = 0;
    for (size_t i = begin; i < begin + bytes; ++i)
      value = value << 8 | static_cast<unsigned char>(head[i]);
    return value;
  };
  if (number(kChanges, 4) != number(kPagesValid, 4)) return 0;
  const uintmax_t page_bytes = number(kPageSize, 2);
  return (page_bytes == 1 ? 65536 : page_bytes) * number(kPages, 4);
}

}  // namespace

struct Database::State {
  sqlite3* handle = nullptr;
  std::string name;  // path of the file, for messages
  std::string what;  // name of this kind of file in messages: "package"
  ErrorKind kind = ErrorKind::kInput;
  int64_t most_steps = INT64_MAX;  // limit of the steps of SQLite's virtual machine for one command

  ~State() { sqlite3_close(handle); }

  // Returns what the system said of a fault that SQLite only calls "disk I/O error" (all but a full
  // disk), and SQLite's number of the operation that failed; empty for other errors.
  std::string DiskFault() const {
    const int code = sqlite3_extended_errcode(handle);
    if ((code & 0xff) != SQLITE_IOERR) return "";
    int cause = sqlite3_system_errno(handle);
    if (cause == 0) sqlite3_file_control(handle, "main", SQLITE_FCNTL_LAST_ERRNO, &cause);
    return fmt::format(" ({}SQLite's code {})",
                       cause == 0 ? "" : fmt::format("{}; ", strerror(cause)), code);
  }
  Error Fault(std::string_view message) const {
    return {kind, fmt::format("{}: {}", name, message)};
  }
  // Returns the last error of SQLite for this database.
  Error Failed() const {
    const std::string message = sqlite3_errmsg(handle);
    if (kind == ErrorKind::kOutput)
      return Fault(fmt::format("cannot be written: {}{}", message, DiskFault()));
    return Fault(
        fmt::format("is no {}, or a damaged one: {}; copy or make it again", what, message));
  }
};

struct Statement::State {
  sqlite3_stmt* handle = nullptr;
  std::shared_ptr<Database::State> database;
  int64_t steps = 0;  // steps of SQLite's virtual machine since the command began
  bool is_too_long = false;

  ~State() { sqlite3_finalize(handle); }
};

Statement::Statement(std::unique_ptr<State> state) : state_(std::move(state)) {}
Statement::Statement(Statement&&) noexcept = default;
Statement& Statement::operator=(Statement&&) noexcept = default;
Statement::~Statement() = default;

Statement& Statement::Bind(int parameter, int64_t value) {
  LF_CHECK(sqlite3_bind_int64(state_->handle, parameter + 1, value) == SQLITE_OK);
  return *this;
}

Statement& Statement::Bind(int parameter, double value) {
  LF_CHECK(sqlite3_bind_double(state_->handle, parameter + 1, value) == SQLITE_OK);
  return *this;
}

Statement& Statement::Bind(int parameter, std::string_view text) {
  // SQLite would store a null pointer as NULL and not as an empty text.
  const char* const letters = text.empty() ? "" : text.data();
  LF_CHECK(sqlite3_bind_text64(state_->handle, parameter + 1, letters, text.size(),
                               SQLITE_TRANSIENT, SQLITE_UTF8) == SQLITE_OK);
  return *this;
}

Statement& Statement::BindBlob(int parameter, std::string_view bytes) {
  const std::string stored = std::string(bytes) + HashText(bytes);
  LF_CHECK(sqlite3_bind_blob64(state_->handle, parameter + 1, stored.data(), stored.size(),
                               SQLITE_TRANSIENT) == SQLITE_OK);
  return *this;
}

Statement& Statement::BindNull(int parameter) {
  LF_CHECK(sqlite3_bind_null(state_->handle, parameter + 1) == SQLITE_OK);
  return *this;
}

Result<bool> Statement::Step() {
  const auto look = [](void* statement) -> int {
    auto* const state = static_cast<State*>(statement);
    state->steps += kStepsBetweenLooks;
    state->is_too_long = state->steps > state->database->most_steps;
    return state->is_too_long ? 1 : 0;
  };
  sqlite3_progress_handler(state_->database->handle, kStepsBetweenLooks, look, state_.get());
  const int code = sqlite3_step(state_->handle);
  sqlite3_progress_handler(state_->database->handle, 0, nullptr, nullptr);
  if (code == SQLITE_ROW) return true;
  Error error = code == SQLITE_DONE ? Error() : state_->database->Failed();
  if (state_->is_too_long)
    error = state_->database->Fault(
        "is damaged: reading its tables does not end; copy or make it again");
  Reset();
  if (code == SQLITE_DONE) return false;
  return error;
}

Result<void> Statement::Run() {
  LF_ASSIGN_OR_RETURN(const bool has_row, Step());
  LF_CHECK(!has_row);
  return {};
}

void Statement::Reset() {
  sqlite3_reset(state_->handle);
  state_->steps = 0;
  state_->is_too_long = false;
}

bool Statement::IsNull(int column) const {
  return sqlite3_column_type(state_->handle, column) == SQLITE_NULL;
}

Error Statement::Wrong(int column, std::string_view found, std::string_view expected) const {
  // A wrong value is kInput even if the database is opened for writing.
  return InputError(fmt::format(
      "{}: is damaged: found {} in column {}, expected {}; copy or make it again",
      state_->database->name, found, sqlite3_column_name(state_->handle, column), expected));
}

Result<int64_t> Statement::Integer(int column) const {
  return Integer(column, INT64_MIN, INT64_MAX);
}

Result<int64_t> Statement::Integer(int column, int64_t low, int64_t high) const {
  if (sqlite3_column_type(state_->handle, column) != SQLITE_INTEGER)
    return Wrong(column, "something else", "a whole number");
  const int64_t value = sqlite3_column_int64(state_->handle, column);
  if (value < low || value > high)
    return Wrong(column, fmt::format("{}", value), fmt::format("{} to {}", low, high));
  return value;
}

Result<double> Statement::Real(int column) const {
  const int type = sqlite3_column_type(state_->handle, column);
  const double value = sqlite3_column_double(state_->handle, column);
  if ((type != SQLITE_FLOAT && type != SQLITE_INTEGER) || !std::isfinite(value))
    return Wrong(column, "something else", "a finite number");
  return value;
}

Result<std::string> Statement::Text(int column) const {
  if (sqlite3_column_type(state_->handle, column) != SQLITE_TEXT)
    return Wrong(column, "something else", "text");
  const auto* const text =
      reinterpret_cast<const char*>(sqlite3_column_text(state_->handle, column));
  const auto size = static_cast<size_t>(sqlite3_column_bytes(state_->handle, column));
  return std::string(text, size);
}

Result<std::string_view> Statement::Blob(int column) const {
  if (sqlite3_column_type(state_->handle, column) != SQLITE_BLOB)
    return Wrong(column, "something else", "bytes");
  const auto* const data = static_cast<const char*>(sqlite3_column_blob(state_->handle, column));
  const auto size = static_cast<size_t>(sqlite3_column_bytes(state_->handle, column));
  if (size < kHashBytes) return Wrong(column, fmt::format("{} bytes", size), "8 or more");
  const std::string_view stored(data, size), bytes = stored.substr(0, size - kHashBytes);
  if (HashText(bytes) != stored.substr(bytes.size()))
    return Wrong(column, "bytes with a wrong checksum", "the bytes that were written");
  return bytes;
}

Database::Database(std::shared_ptr<State> state) : state_(std::move(state)) {}
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;
Database::~Database() = default;

Error Database::Fault(std::string_view message) const { return state_->Fault(message); }

const std::string& Database::name() const { return state_->name; }

Result<void> Database::Execute(const std::string& sql) {
  if (sqlite3_exec(state_->handle, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    return state_->Failed();
  return {};
}

Result<Statement> Database::Prepare(const std::string& sql) {
  auto statement = std::make_unique<Statement::State>();
  statement->database = state_;
  const auto size = static_cast<int>(sql.size());
  if (sqlite3_prepare_v2(state_->handle, sql.data(), size, &statement->handle, nullptr) !=
      SQLITE_OK)
    return state_->Failed();
  return Statement(std::move(statement));
}

Result<void> Database::ReadFront(const char* table, const char* column, int64_t row, size_t count,
                                 std::string* bytes) {
  sqlite3_blob* opened = nullptr;
  if (sqlite3_blob_open(state_->handle, "main", table, column, row, 0, &opened) != SQLITE_OK)
    return state_->Failed();
  const std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob(opened, sqlite3_blob_close);
  const auto size = static_cast<size_t>(sqlite3_blob_bytes(blob.get()));
  if (size < kHashBytes || count > size - kHashBytes)
    return Fault(
        fmt::format("is damaged: found {} bytes in column {}, expected at least {}; copy "
                    "or make it again",
                    size, column, count + kHashBytes));
  bytes->resize(count);
  if (sqlite3_blob_read(blob.get(), bytes->data(), static_cast<int>(count), 0) != SQLITE_OK)
    return state_->Failed();
  return {};
}

Result<void> Database::CheckTables(const std::vector<std::string>& scripts) {
  using Tables = std::vector<std::string>;
  const auto tables_of = [](Database& database) -> Result<Tables> {
    Tables tables;
    LF_RETURN_IF_ERROR(ForEachRow(
        database, "select type || ' ' || name || ' ' || coalesce(sql, '') from sqlite_master",
        [&](const Statement& row) -> Result<void> {
          LF_ASSIGN_OR_RETURN(std::string table, row.Text(0));
          tables.push_back(std::move(table));
          return {};
        }));
    std::sort(tables.begin(), tables.end());
    return tables;
  };
  LF_ASSIGN_OR_RETURN(const Tables found, tables_of(*this));
  for (const std::string& script : scripts) {
    auto state = std::make_shared<State>();
    state->name = state_->name;
    LF_CHECK(sqlite3_open(":memory:", &state->handle) == SQLITE_OK);
    Database ours(std::move(state));
    LF_RETURN_IF_ERROR(ours.Execute(script));
    LF_ASSIGN_OR_RETURN(const Tables allowed, tables_of(ours));
    if (found == allowed) return {};
  }
  return Fault(
      fmt::format("is damaged, or made by another program: its tables are not those of a {}; copy "
                  "or make it again",
                  state_->what));
}

Result<int64_t> Database::Pragma(const char* name) {
  LF_ASSIGN_OR_RETURN(Statement statement, Prepare(fmt::format("pragma {}", name)));
  LF_ASSIGN_OR_RETURN(const bool has_row, statement.Step());
  if (!has_row) return Fault(fmt::format("is no {}", state_->what));
  return statement.Integer(0);
}

// Returns kInput for a file of another kind or version, even if the database is opened for writing.
Result<void> Database::CheckFormat(const DatabaseFormat& format) {
  const auto wrong = [this](const std::string& message) {
    return InputError(Fault(message).message);
  };
  LF_ASSIGN_OR_RETURN(const int64_t id, Pragma("application_id"));
  if (id != static_cast<int32_t>(format.application_id))
    return wrong(fmt::format("is no {} (another SQLite file, application_id {})", format.name, id));
  LF_ASSIGN_OR_RETURN(const int64_t version, Pragma("user_version"));
  if (version > format.version)
    return wrong(
        fmt::format("is a {} of version {}, which a newer lfrendertools has written; this one "
                    "knows version {}: use the newer one",
                    format.name, version, format.version));
  if (version < format.version)
    return wrong(
        fmt::format("is a {} of version {}, which {} read; this one knows version {}: use "
                    "such a build, or make it again",
                    format.name, version, kBuildsOfEarlierFiles, format.version));
  return {};
}

Result<Database> Database::Create(const fs::path& path, const DatabaseFormat& format) {
  auto state = std::make_shared<State>();
  state->name = path.string();
  state->what = format.name;
  state->kind = ErrorKind::kOutput;
  std::error_code ignored;
  fs::remove(path, ignored);
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(path.c_str(), &state->handle, kFlags, kWithoutLocks) != SQLITE_OK)
    return state->Failed();
  Database database(std::move(state));
  // No journal is needed, because the file has a temporary name and is flushed when it is complete.
  LF_RETURN_IF_ERROR(database.Execute(
      fmt::format("pragma page_size = {}; pragma journal_mode = off; pragma synchronous = off; "
                  "pragma application_id = {}; pragma user_version = {};",
                  format.page_bytes, static_cast<int32_t>(format.application_id), format.version)));
  return database;
}

Result<Database> Database::OpenToAppend(const fs::path& path, const DatabaseFormat& format) {
  auto state = std::make_shared<State>();
  state->name = path.string();
  state->what = format.name;
  state->kind = ErrorKind::kOutput;
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(path.c_str(), &state->handle, kFlags, kWithoutLocks) != SQLITE_OK)
    return state->Failed();
  Database database(std::move(state));
  // Uses a rollback journal and not a write-ahead log: batches write new pages, which the journal
  // need not save, and after every batch the file is complete without any other file. Reading
  // page_count below rolls back an interrupted batch of an earlier program.
  LF_RETURN_IF_ERROR(database.Execute(
      fmt::format("pragma page_size = {}; pragma journal_mode = delete; pragma synchronous = full;",
                  format.page_bytes)));
  LF_ASSIGN_OR_RETURN(const int64_t page_count, database.Pragma("page_count"));
  // SQLite leaves a journal in place if there was nothing to roll back. Such a journal is no longer
  // needed.
  std::error_code ignored;
  fs::remove(fs::path(path) += "-journal", ignored);
  if (page_count > 0) {
    LF_RETURN_IF_ERROR(database.CheckFormat(format));
    return database;
  }
  // One transaction sets both pragmas or none, even if the program is killed here.
  LF_RETURN_IF_ERROR(database.Execute(
      fmt::format("begin; pragma application_id = {}; pragma user_version = {}; commit",
                  static_cast<int32_t>(format.application_id), format.version)));
  return database;
}

Result<Database> Database::Open(const fs::path& path, const DatabaseFormat& format,
                                const std::vector<std::string>& scripts) {
  auto state = std::make_shared<State>();
  state->name = path.string();
  state->what = format.name;
  std::error_code error;
  if (!fs::exists(path, error))
    return state->Fault(error ? "cannot be read: " + error.message() : "no such file");
  if (!fs::is_regular_file(path, error)) return state->Fault("is no file");
  const uintmax_t size = fs::file_size(path, error), expected = BytesOfPages(path);
  if (!error && size < expected)
    return state->Fault(
        fmt::format("is damaged: it ends after {} of {} bytes, probably because it was copied in "
                    "part; copy or make it again",
                    size, expected));
  constexpr int kFlags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(UriOf(path).c_str(), &state->handle, kFlags, nullptr) != SQLITE_OK)
    return state->Fault(fmt::format("cannot be read: {}", sqlite3_errmsg(state->handle)));
  // Anybody may have made the file, so SQLite must not run any code that the file contains.
  sqlite3_db_config(state->handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(state->handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // Limits the bytes of one value, for which SQLite allocates memory, to the length of the file
  // (but at least kLeastLimit), whatever length a damaged row states.
  constexpr uintmax_t kLeastLimit = 1 << 20;
  const uintmax_t longest = std::clamp<uintmax_t>(size, kLeastLimit, kMaxBlobBytes);
  sqlite3_limit(state->handle, SQLITE_LIMIT_LENGTH, static_cast<int>(longest));
  state->most_steps = kStepsOfSmallFile + kStepsOfByte * static_cast<int64_t>(size);
  Database database(std::move(state));
  LF_RETURN_IF_ERROR(database.Execute("pragma cell_size_check = on; pragma mmap_size = 0;"));
  LF_RETURN_IF_ERROR(database.CheckFormat(format));
  LF_RETURN_IF_ERROR(database.CheckTables(scripts));
  return database;
}

}  // namespace lf
