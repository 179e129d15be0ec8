#include "lf/database/database.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <limits>

#include "lf/core/file.h"
#include "lf/core/random.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr DatabaseFormat kFormat = {"test file", 0x4C465454, 3};
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

  // Rows of (key, number, word, blob).
  fs::path Write(int rows = 20, const DatabaseFormat& format = kFormat) {
    const fs::path path = folder_ / "a file %41 ?immutable=0 #1.lfp";
    Result<Database> database = Database::Create(path, format);
    EXPECT_TRUE(database) << database.error().message;
    EXPECT_TRUE(database->Execute(
        "create table things (key integer primary key, number real, word text, bytes blob); "
        "begin"));
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

  // How many rows are as they were written; an error is one that says so.
  static Result<int> ReadAll(const fs::path& path) {
    LF_ASSIGN_OR_RETURN(Database database, Database::Open(path, kFormat));
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
  // In place of it, a smaller one.
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
  EXPECT_NE(FaultOf(Write(1, {"test file", 0x4C465454, 2})).find("too old"), std::string::npos);
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

TEST_F(DatabaseTest, ColumnsOfOtherTypesAreNamed) {
  Database database = Database::Open(Write(2), kFormat).value();
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
  {
    Database database = Database::Create(path, kFormat).value();
    ASSERT_TRUE(database.Execute("create table n (i integer, r real)"));
    Statement insert = database.Prepare("insert into n values (?, ?)").value();
    for (const double value : {0.1, -1.0 / 3, 1e-300, std::numeric_limits<double>::denorm_min()}) {
      insert.Bind(0, std::numeric_limits<int64_t>::min()).Bind(1, value);
      ASSERT_TRUE(insert.Run());
    }
  }
  Database database = Database::Open(path, kFormat).value();
  Statement select = database.Prepare("select i, r from n").value();
  for (const double value : {0.1, -1.0 / 3, 1e-300, std::numeric_limits<double>::denorm_min()}) {
    ASSERT_TRUE(*select.Step());
    EXPECT_EQ(*select.Integer(0), std::numeric_limits<int64_t>::min());
    EXPECT_EQ(*select.Real(1), value);
  }
}

TEST_F(DatabaseTest, WhatCannotBeWrittenIsAnOutputError) {
  const Result<Database> database = Database::Create(folder_ / "no" / "folder", kFormat);
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
