// SPDX-License-Identifier: Apache-2.0
// Reads and writes our SQLite files: packages and packed stores (doc/design.md, "SQLite is the file
// format"). No other folder uses SQLite.
//
// A file states its kind by its application_id, and its version by its user_version. It is written
// under a temporary name, either at once (core/file.h) or in batches over hours. When it is
// complete, it is only read, as immutable and without locks, so that any number of machines may
// read it over a network file system.
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
  const char* name;         // name of this kind of file in messages: "package"
  uint32_t application_id;  // SQLite's id of the file's kind: four letters, first in highest byte
  int version;              // version that this program writes; it can read no other version
  int page_bytes = 65536;   // size of SQLite's pages, a power of 2; should be small for small files
};

// One prepared SQL command, which is run step by step. It keeps its database open. Columns and
// parameters are counted from 0.
class Statement {
 public:
  Statement(Statement&&) noexcept;
  Statement& operator=(Statement&&) noexcept;
  ~Statement();

  Statement& Bind(int parameter, int64_t value);
  Statement& Bind(int parameter, double value);  // stores all bits of any value but NaN
  Statement& Bind(int parameter, std::string_view text);
  // Binds bytes followed by their checksum, to be read by Blob().
  Statement& BindBlob(int parameter, std::string_view bytes);
  Statement& BindNull(int parameter);

  // Moves to the next row. Returns false if there is none; the command may then be bound and run
  // again. Errors are kInput (damage) for a database that is read, and kOutput (a disk failure) for
  // one that is written. It is an error if a command takes more steps of SQLite's virtual machine
  // than an intact file of this length can need, because the file is then damaged.
  Result<bool> Step();
  // Runs a command that returns no rows.
  Result<void> Run();
  // Ends a command before its last row, so that it may be bound and run again.
  void Reset();

  bool IsNull(int column) const;
  // These functions return a value of the current row. An error of the same kind as from Step() if
  // the column has another type, the number is outside of [low, high], or a blob's checksum is
  // wrong.
  Result<int64_t> Integer(int column) const;
  Result<int64_t> Integer(int column, int64_t low, int64_t high) const;
  Result<double> Real(int column) const;  // the number is finite
  Result<std::string> Text(int column) const;
  // Returns the bytes without their checksum. They are valid until the next Step() or Reset().
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
  // Creates an empty database and replaces an existing file of this name. kOutput: it cannot be
  // written.
  static Result<Database> Create(const std::filesystem::path& path, const DatabaseFormat& format);
  // Opens a file for reading. The SQL scripts are alternatives: the file must have exactly the
  // tables and indices that one of the scripts creates, by the same SQL. kInput: the file cannot be
  // read, is no database, is of another kind or version, was copied only in part, or has other
  // tables and indices. No table is read before this check, because a view or a generated column in
  // place of a table could take any time and memory.
  static Result<Database> Open(const std::filesystem::path& path, const DatabaseFormat& format,
                               const std::vector<std::string>& scripts);

  // Opens a file for writing in batches. Creates it if it does not exist or is empty, otherwise
  // keeps its contents. Committed batches ("begin" and "commit" by Execute()) are on the disk and
  // survive however the program ends: the next OpenToAppend() finds all committed batches, and
  // nothing of an uncommitted one. During a batch a file FILE-journal may exist beside the file.
  // After a crash it must stay there until the next OpenToAppend(), which undoes the uncommitted
  // batch and removes it. One program at a time may open the file. kOutput: the file cannot be
  // written. kInput: it is of another kind or version.
  static Result<Database> OpenToAppend(const std::filesystem::path& path,
                                       const DatabaseFormat& format);

  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  // Runs commands that return no rows, separated by semicolons.
  Result<void> Execute(const std::string& sql);
  Result<Statement> Prepare(const std::string& sql);

  // Reads the first `count` bytes of a value that BindBlob() has stored, without reading the rest
  // or checking its checksum. An error as from Statement::Step() if there is no such row, or if it
  // has no so many bytes.
  //   row  value of the row's integer primary key
  Result<void> ReadFront(const char* table, const char* column, int64_t row, size_t count,
                         std::string* bytes);

  const std::string& name() const;  // path of the file, as messages show it
  // Returns the error "package-0000.lfp: " + message: kInput, or kOutput for a database that is
  // written.
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

// Returns true if the database has a table of this name.
inline Result<bool> HasTable(Database* database, std::string_view name) {
  LF_ASSIGN_OR_RETURN(
      Statement select,
      database->Prepare("select 1 from sqlite_master where name = ? and type = 'table'"));
  select.Bind(0, name);
  return select.Step();
}

// Calls row(statement), which returns a Result<void>, for every row that an SQL command without
// parameters returns. Ends at the first error.
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
