// SQLite files of ours: packages and packed stores (doc/design.md, "SQLite is the file format").
// The only folder that knows SQLite.
//
// A file says what it is by its application_id, and in which version by its user_version. It is
// written under a temporary name, whole (core/file.h) or in batches over hours, and then only read:
// immutable, without locks, so that any number of machines may read it over a network file system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct DatabaseFormat {
  const char* name;         // as messages call such a file: "package"
  uint32_t application_id;  // four letters
  int version;              // of what this program writes; older ones are not known
  int page_bytes = 65536;   // a power of 2; small files want small ones
};

// One command, prepared; run by steps. The database must outlive it. Columns and parameters count
// from 0.
class Statement {
 public:
  Statement(Statement&&) noexcept;
  Statement& operator=(Statement&&) noexcept;
  ~Statement();

  Statement& Bind(int parameter, int64_t value);
  Statement& Bind(int parameter, double value);  // all of its bits are kept, but for NaN
  Statement& Bind(int parameter, std::string_view text);
  // Bytes, with their checksum behind them: read by Blob().
  Statement& BindBlob(int parameter, std::string_view bytes);
  Statement& BindNull(int parameter);

  // Whether there is a (next) row; false when the command is done, after which it may be bound and
  // run again. Errors of the kind of the database: damage when reading, the disk when writing. A
  // command that takes more steps than a file of this length can need is damage, too.
  Result<bool> Step();
  // Of a command without rows: runs it to its end.
  Result<void> Run();
  // Ends a command before its last row: it may be bound and run again.
  void Reset();

  bool IsNull(int column) const;
  // Of the row. kInput where the column has another type, and where a blob's checksum is wrong.
  Result<int64_t> Integer(int column) const;
  Result<int64_t> Integer(int column, int64_t low, int64_t high) const;
  Result<double> Real(int column) const;  // finite
  Result<std::string> Text(int column) const;
  // The bytes without their checksum; until the next step.
  Result<std::string_view> Blob(int column) const;

 private:
  friend class Database;
  struct State;
  explicit Statement(std::unique_ptr<State> state);
  Error Wrong(int column, std::string_view found, std::string_view expected) const;
  std::unique_ptr<State> state_;
};

class Database {
 public:
  // A new, empty one in place of what has the name. kOutput.
  static Result<Database> Create(const std::filesystem::path& path, const DatabaseFormat& format);
  // To be read. kInput: it cannot be read, is none, is of another kind or version, was copied in
  // part, or has other tables and indices than one of these scripts makes, compared letter by
  // letter. A view or a generated column in place of a table could take any time and memory, so
  // nothing is selected before this is known.
  static Result<Database> Open(const std::filesystem::path& path, const DatabaseFormat& format,
                               const std::vector<std::string>& scripts);

  // To be written in batches: made if it is not there or empty, else what it holds stays. What is
  // committed ("begin" and "commit" by Execute()) is on the disk and survives the program, however
  // it ends: the next OpenToAppend() finds all batches that were committed, and nothing of the one
  // that was not. Beside the file there may be one more, FILE-journal, which belongs to it until it
  // is opened and closed again; between batches there is none. For one program at a time.
  // kOutput; kInput: it is of another kind or version.
  static Result<Database> OpenToAppend(const std::filesystem::path& path,
                                       const DatabaseFormat& format);

  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  // Commands without rows, separated by semicolons.
  Result<void> Execute(const std::string& sql);
  Result<Statement> Prepare(const std::string& sql);

  const std::string& name() const;  // as messages call it: its path
  // "package-0000.lfp: " + message; kInput, or kOutput of one that is written.
  Error Fault(std::string_view message) const;

 private:
  friend class Statement;
  struct State;
  explicit Database(std::shared_ptr<State> state);
  Result<int64_t> Pragma(const char* name);
  Result<void> CheckFormat(const DatabaseFormat& format);
  Result<void> CheckTables(const std::vector<std::string>& scripts);
  std::shared_ptr<State> state_;
};

// Calls row(statement), which gives a Result<void>, for every row of a command without parameters.
template <class Row>
Result<void> ForEachRow(Database& database, const std::string& sql, const Row& row) {
  LF_ASSIGN_OR_RETURN(Statement select, database.Prepare(sql));
  while (true) {
    LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
    if (!has_row) return {};
    LF_RETURN_IF_ERROR(row(select));
  }
}

}  // namespace lf
