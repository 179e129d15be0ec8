// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/sqlite/database.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <limits>

#include "lf/core/file.h"
#include "lf/core/random.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr DatabaseFormat kFormat = {"test file", 0x4C465454, 3};
constexpr const char* kThings =
    "create table things (key integer primary key, number real, word text, bytes blob)";
constexpr const char* kWords[] = {"", "one", "two\nlines", "Überall ✓"};

class DatabaseTest : public ::testing::Test {
 protected:
  DatabaseTest()
      : folder_(fs::temp_directory_path() /
                ("lf_database_test." + std::to_string(::getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~DatabaseTest() override { fs::remove_all(folder_); }

  // Writes rows of (key, number, word, blob).
  fs::path Write(int rows = 20, const DatabaseFormat& format = kFormat) {
    const fs::path path = folder_ / "a file %41 ?immutable=0 #1.lfp";
    Result<Database> database = Database::Create(path, format);
    EXPECT_TRUE(database) << database.error().message;
    EXPECT_TRUE(database->Execute(kThings));
    EXPECT_TRUE(database->Execute("begin"));
    Result<Statement> insert = database->Prepare("insert into things values (?, ?, ?, ?)");
    EXPECT_TRUE(insert);
    for (int i = 0; i < rows; ++i) {
      insert->Bind(0, int64_t{i}).Bind(1, 0.1 * i).Bind(2, std::string_view(kWords[i % 4]));
      insert->BindBlob(3, BytesOf(i));
      EXPECT_TRUE(insert->Run());
    }
    EXPECT_TRUE(database->Execute("commit"));
    return path;
  }

  static std::string BytesOf(int row) {
    std::string bytes;
    for (uint64_t k = 0; k < 7 * static_cast<uint64_t>(row); ++k)
      bytes += static_cast<char>(RandomBits(1, static_cast<uint64_t>(row), k));
    return bytes;
  }

  // Returns how many rows have their original values; an error if the file cannot be opened or
  // read.
  static Result<int> ReadAll(const fs::path& path) {
    LF_ASSIGN_OR_RETURN(Database database, Database::Open(path, kFormat, {kThings}));
    LF_ASSIGN_OR_RETURN(Statement select,
                        database.Prepare("select key, number, word, bytes from things order by 1"));
    int rows = 0;
    while (true) {
      LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
      if (!has_row) return rows;
      LF_ASSIGN_OR_RETURN(const int64_t key, select.Integer(0, 0, 1000));
      LF_ASSIGN_OR_RETURN(const double number, select.Real(1));
      LF_ASSIGN_OR_RETURN(const std::string word, select.Text(2));
      LF_ASSIGN_OR_RETURN(const std::string_view bytes, select.Blob(3));
      const int i = static_cast<int>(key);
      rows += number == 0.1 * i && word == kWords[i % 4] && bytes == BytesOf(i);
    }
  }

  static std::string FaultOf(const fs::path& path) {
    const Result<int> rows = ReadAll(path);
    if (rows) return "";
    EXPECT_EQ(rows.error().kind, ErrorKind::kInput);
    EXPECT_NE(rows.error().message.find(path.string()), std::string::npos);
    return rows.error().message;
  }

  fs::path folder_;
};

TEST_F(DatabaseTest, ReadsWhatWasWritten) {
  const Result<int> rows = ReadAll(Write());
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(*rows, 20);
  // Write() replaces the file by a smaller one.
  EXPECT_EQ(*ReadAll(Write(3)), 3);
}

TEST_F(DatabaseTest, NamesWhatIsNoSuchFile) {
  EXPECT_NE(FaultOf(folder_ / "missing").find("no such file"), std::string::npos);
  EXPECT_NE(FaultOf(folder_).find("is no file"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "text", "this is no database, but a text"));
  EXPECT_NE(FaultOf(folder_ / "text").find("is no test file"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "empty", ""));
  EXPECT_NE(FaultOf(folder_ / "empty").find("is no test file"), std::string::npos);
  EXPECT_NE(FaultOf(Write(1, {"other file", 0x4C465455, 3})).find("another SQLite file"),
            std::string::npos);
  EXPECT_NE(FaultOf(Write(1, {"test file", 0x4C465454, 4})).find("of version 4, which a newer"),
            std::string::npos);
  EXPECT_NE(FaultOf(Write(1, {"test file", 0x4C465454, 2})).find("of version 2, which builds of"),
            std::string::npos);
}

TEST_F(DatabaseTest, DamageIsAnErrorOrChangesNothing) {
  const fs::path path = Write(200);
  const std::string whole = *ReadFile(path);
  size_t errors = 0;
  for (uint64_t i = 0; i < 400; ++i) {
    std::string damaged = whole;
    const uint64_t at = RandomBits(2, i, 0) % whole.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 8)));
    ASSERT_TRUE(WriteFileAtomically(path, damaged));
    const Result<int> rows = ReadAll(path);
    errors += !rows;
    if (rows) {
      EXPECT_GE(*rows, 199) << at;  // keys, numbers and words have no checksum
    }
  }
  EXPECT_GT(errors, 50u);
  for (const size_t size : {whole.size() / 2, whole.size() - 1, size_t{100}, size_t{17}}) {
    ASSERT_TRUE(WriteFileAtomically(path, whole.substr(0, size)));
    EXPECT_NE(FaultOf(path), "") << size;
  }
}

// The first bytes of a blob are read without the rest. More than it has, other rows and other
// columns are errors.
TEST_F(DatabaseTest, ReadsTheFrontOfABlob) {
  Database database = Database::Open(Write(), kFormat, {kThings}).value();
  std::string front;
  for (const size_t count : {0, 1, 40, 70}) {
    ASSERT_TRUE(database.ReadFront("things", "bytes", 10, count, &front));
    EXPECT_EQ(front, BytesOf(10).substr(0, count));
  }
  const auto message_of = [&](const char* column, int64_t row, size_t count) {
    const Result<void> read = database.ReadFront("things", column, row, count, &front);
    return read ? std::string() : read.error().message;
  };
  EXPECT_NE(
      message_of("bytes", 10, 71).find("found 78 bytes in column bytes, expected at least 79"),
      std::string::npos);
  EXPECT_NE(message_of("bytes", 999, 1).find("a damaged one"), std::string::npos);
  EXPECT_NE(message_of("number", 3, 1), "");
  EXPECT_NE(message_of("nothing", 3, 1), "");
}

TEST_F(DatabaseTest, ColumnsOfOtherTypesAreNamed) {
  Database database = Database::Open(Write(2), kFormat, {kThings}).value();
  const auto fault = [&](const char* sql, const auto& read) {
    Statement statement = database.Prepare(sql).value();
    EXPECT_TRUE(*statement.Step());
    const auto value = read(statement);
    EXPECT_FALSE(value);
    return value ? std::string() : value.error().message;
  };
  EXPECT_NE(fault("select word from things", [](auto& s) { return s.Integer(0); }).find("word"),
            std::string::npos);
  EXPECT_NE(fault("select 5 as n", [](auto& s) { return s.Integer(0, 0, 4); }).find("0 to 4"),
            std::string::npos);
  EXPECT_NE(fault("select word from things", [](auto& s) { return s.Real(0); }), "");
  EXPECT_NE(fault("select 9e999", [](auto& s) { return s.Real(0); }), "");
  EXPECT_NE(fault("select 5", [](auto& s) { return s.Text(0); }), "");
  EXPECT_NE(fault("select 5", [](auto& s) { return s.Blob(0); }), "");
  EXPECT_NE(fault("select x'00112233'", [](auto& s) { return s.Blob(0); }), "");
  EXPECT_NE(
      fault("select x'001122334455667788'", [](auto& s) { return s.Blob(0); }).find("checksum"),
      std::string::npos);
}

TEST_F(DatabaseTest, KeepsAllBitsOfNumbers) {
  const fs::path path = folder_ / "numbers";
  constexpr const char* kNumbers = "create table n (i integer, r real)";
  {
    Database database = Database::Create(path, kFormat).value();
    ASSERT_TRUE(database.Execute(kNumbers));
    Statement insert = database.Prepare("insert into n values (?, ?)").value();
    for (const double value : {0.1, -1.0 / 3, 1e-300, std::numeric_limits<double>::denorm_min()}) {
      insert.Bind(0, std::numeric_limits<int64_t>::min()).Bind(1, value);
      ASSERT_TRUE(insert.Run());
    }
  }
  Database database = Database::Open(path, kFormat, {kNumbers}).value();
  Statement select = database.Prepare("select i, r from n").value();
  for (const double value : {0.1, -1.0 / 3, 1e-300, std::numeric_limits<double>::denorm_min()}) {
    ASSERT_TRUE(*select.Step());
    EXPECT_EQ(*select.Integer(0), std::numeric_limits<int64_t>::min());
    EXPECT_EQ(*select.Real(1), value);
  }
}

// The files have other tables, views, triggers or indices than expected, and are correct in every
// other way.
TEST_F(DatabaseTest, OtherTablesAreRefusedBeforeTheyAreRead) {
  const std::string endless =
      "with recursive c(x) as (select 0 union all select x + 1 from c) select x as key, "
      "1.0 as number, 'w' as word, zeroblob(900000000) as bytes from c;";
  for (const std::string& change :
       {"drop table things; create view things as " + endless,
        std::string("create view more as select * from things;"),
        std::string("create trigger t after insert on things begin select 1; end;"),
        std::string("create index i on things (word);"), std::string("drop table things;"),
        std::string("drop table things; create table things (key integer primary key, number real, "
                    "word text, bytes blob generated always as (zeroblob(900000000)) virtual);"),
        std::string("alter table things add column more text;")}) {
    const fs::path path = Write();
    {
      Database database = Database::OpenToAppend(path, kFormat).value();
      ASSERT_TRUE(database.Execute(change)) << change;
    }
    const Result<Database> opened = Database::Open(path, kFormat, {"create table a (b)", kThings});
    ASSERT_FALSE(opened) << change;
    EXPECT_EQ(opened.error().kind, ErrorKind::kInput);
    EXPECT_NE(opened.error().message.find("its tables are not those of a test file"),
              std::string::npos)
        << opened.error().message;
  }
  EXPECT_TRUE(Database::Open(Write(), kFormat, {"create table a (b)", kThings}));
}

TEST_F(DatabaseTest, CommandsWithoutEndAreDamage) {
  Database database = Database::Open(Write(), kFormat, {kThings}).value();
  Statement endless = database
                          .Prepare(
                              "with recursive c(x) as (select 0 union all select x + 1 from c) "
                              "select count(*) from c")
                          .value();
  const Result<bool> step = endless.Step();
  ASSERT_FALSE(step);
  EXPECT_NE(step.error().message.find("does not end"), std::string::npos) << step.error().message;
  // The step limit applies to each command separately.
  Statement again = database.Prepare("select count(*) from things").value();
  ASSERT_TRUE(again.Step());
  EXPECT_EQ(*again.Integer(0), 20);
}

TEST_F(DatabaseTest, WhatCannotBeWrittenIsAnOutputError) {
  const Result<Database> database = Database::Create(folder_ / "no" / "folder", kFormat);
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().kind, ErrorKind::kOutput);
}

constexpr const char* kBatches =
    "create table things (key integer primary key, bytes blob not null)";

// Appends three rows in each batch, and calls told(row count) after each batch.
template <class Told>
Result<void> AppendBatches(const fs::path& path, int batch_count, const Told& told) {
  LF_ASSIGN_OR_RETURN(Database database, Database::OpenToAppend(path, kFormat));
  LF_ASSIGN_OR_RETURN(Statement is_there, database.Prepare("select count(*) from sqlite_master"));
  LF_RETURN_IF_ERROR(is_there.Step());
  LF_ASSIGN_OR_RETURN(const int64_t tables, is_there.Integer(0));
  is_there.Reset();
  if (tables == 0) LF_RETURN_IF_ERROR(database.Execute(kBatches));
  LF_ASSIGN_OR_RETURN(Statement insert, database.Prepare("insert into things values (?, ?)"));
  LF_ASSIGN_OR_RETURN(Statement count, database.Prepare("select count(*) from things"));
  LF_RETURN_IF_ERROR(count.Step());
  LF_ASSIGN_OR_RETURN(int64_t row, count.Integer(0));
  count.Reset();
  for (int batch = 0; batch < batch_count; ++batch) {
    LF_RETURN_IF_ERROR(database.Execute("begin"));
    for (int i = 0; i < 3; ++i, ++row) {
      insert.Bind(0, row).BindBlob(1, std::string(30000, static_cast<char>(row)));
      LF_RETURN_IF_ERROR(insert.Run());
    }
    LF_RETURN_IF_ERROR(database.Execute("commit"));
    told(row);
  }
  return {};
}

// Returns the number of rows, all of which must be complete.
int64_t CountWhole(const fs::path& path) {
  Database database = Database::OpenToAppend(path, kFormat).value();
  Statement check = database.Prepare("pragma integrity_check").value();
  EXPECT_TRUE(*check.Step());
  EXPECT_EQ(*check.Text(0), "ok");
  Statement select = database.Prepare("select key, bytes from things order by key").value();
  int64_t row = 0;
  for (; *select.Step(); ++row) {
    EXPECT_EQ(*select.Integer(0), row);
    EXPECT_EQ(*select.Blob(1), std::string(30000, static_cast<char>(row)));
  }
  return row;
}

TEST_F(DatabaseTest, BatchesAreAppended) {
  const fs::path path = folder_ / "batches";
  int64_t told = 0;
  for (int i = 0; i < 3; ++i) {
    const Result<void> appended = AppendBatches(path, 4, [&](int64_t count) { told = count; });
    ASSERT_TRUE(appended) << appended.error().message;
  }
  EXPECT_EQ(told, 36);
  EXPECT_EQ(CountWhole(path), 36);
  // No journal is left beside the file, and Open() reads it like a database written at once.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  EXPECT_TRUE(Database::Open(path, kFormat, {kBatches}));
}

TEST_F(DatabaseTest, AFaultOfTheDiskNamesItsCause) {
  // Files beyond a limit are a fault that SQLite does not take for a full disk.
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit unlimited;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  rlimit small = unlimited;
  small.rlim_cur = 200'000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Result<void> appended = AppendBatches(folder_ / "limited", 40, [](int64_t) {});
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &unlimited), 0);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(appended);
  EXPECT_EQ(appended.error().kind, ErrorKind::kOutput);
  EXPECT_NE(appended.error().message.find("disk I/O error (File too large; SQLite's code 778)"),
            std::string::npos)
      << appended.error().message;
}

TEST_F(DatabaseTest, AWrongValueInAFileToAppendToIsAnInputError) {
  Database database = Database::OpenToAppend(folder_ / "batches", kFormat).value();
  ASSERT_TRUE(database.Execute("create table things (word text); insert into things values ('x')"));
  Statement select = database.Prepare("select word from things").value();
  ASSERT_TRUE(*select.Step());
  EXPECT_EQ(select.Integer(0).error().kind, ErrorKind::kInput);
}

TEST_F(DatabaseTest, WhatWasCommittedSurvivesAKill) {
  const fs::path path = folder_ / "killed";
  int64_t least = 0;
  for (uint64_t round = 0; round < 12; ++round) {
    int pipes[2];
    ASSERT_EQ(::pipe(pipes), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const auto tell = [&](int64_t count) {
        if (::write(pipes[1], &count, sizeof(count)) != sizeof(count)) ::_exit(2);
      };
      ::_exit(AppendBatches(path, 1000000, tell) ? 0 : 1);
    }
    ::close(pipes[1]);
    int64_t count = 0;
    ASSERT_EQ(::read(pipes[0], &count, sizeof(count)), ssize_t{sizeof(count)});
    ::usleep(static_cast<useconds_t>(RandomBits(3, 0, round) % 20000));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    least = count;
    while (::read(pipes[0], &count, sizeof(count)) == ssize_t{sizeof(count)}) least = count;
    ::close(pipes[0]);
    const int64_t found = CountWhole(path);
    EXPECT_GE(found, least);
    EXPECT_LE(found, least + 3);
    EXPECT_EQ(found % 3, 0);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(DatabaseTest, OthersAreNotAppendedTo) {
  const Result<Database> other =
      Database::OpenToAppend(Write(1, {"other file", 0x4C465455, 3}), kFormat);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::kInput);
  EXPECT_NE(other.error().message.find("another SQLite file"), std::string::npos);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "text", std::string(5000, 'x')));
  EXPECT_FALSE(Database::OpenToAppend(folder_ / "text", kFormat));
  EXPECT_FALSE(Database::OpenToAppend(folder_ / "no" / "folder", kFormat));
}

TEST_F(DatabaseTest, NullsAreTold) {
  Database database = Database::OpenToAppend(folder_ / "nulls", kFormat).value();
  ASSERT_TRUE(database.Execute("create table n (a integer, b blob)"));
  Statement insert = database.Prepare("insert into n values (?, ?)").value();
  ASSERT_TRUE(insert.Bind(0, int64_t{1}).BindNull(1).Run());
  Statement select = database.Prepare("select a, b from n").value();
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(*select.Step());
    EXPECT_FALSE(select.IsNull(0));
    EXPECT_TRUE(select.IsNull(1));
    select.Reset();
  }
}

}  // namespace
}  // namespace lf
