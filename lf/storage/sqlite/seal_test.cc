// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/sqlite/seal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "lf/core/file.h"
#include "lf/core/random.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class SealTest : public ::testing::Test {
 protected:
  SealTest()
      : path_(fs::temp_directory_path() / ("lf_seal_test." + std::to_string(::getpid()) + ".lfp")) {
  }
  ~SealTest() override {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  std::string Sealed(size_t size) {
    std::string bytes(size, '\0');
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(RandomBits(1, 0, i));
    EXPECT_TRUE(WriteFileAtomically(path_, bytes));
    EXPECT_TRUE(SealFile(path_));
    return *ReadFile(path_);
  }
  std::string Fault(const std::string& bytes) {
    EXPECT_TRUE(WriteFileAtomically(path_, bytes));
    const Result<void> result = CheckSeal(path_, "package");
    if (!result) {
      EXPECT_EQ(result.error().kind, ErrorKind::kInput);
    }
    return result ? "" : result.error().message;
  }
  fs::path path_;
};

TEST_F(SealTest, EveryByteCounts) {
  const std::string whole = Sealed(1500);
  EXPECT_EQ(whole.size(), 1524u);
  EXPECT_EQ(Fault(whole), "");
  for (size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
    EXPECT_NE(Fault(damaged).find("is a damaged package"), std::string::npos) << at;
  }
}

TEST_F(SealTest, SizesCount) {
  const std::string whole = Sealed((3 << 20) + 7);  // more than is read at a time
  EXPECT_EQ(Fault(whole), "");
  for (const size_t size : {whole.size() - 1, whole.size() - 24, whole.size() / 2, size_t{30},
                            size_t{24}, size_t{3}, size_t{0}})
    EXPECT_NE(Fault(whole.substr(0, size)).find("end is missing"), std::string::npos) << size;
  EXPECT_NE(Fault(whole + "x"), "");
  EXPECT_NE(Fault(whole.substr(1)), "");
}

TEST_F(SealTest, MissingFilesAreErrors) {
  EXPECT_EQ(CheckSeal(path_, "package").error().kind, ErrorKind::kInput);
  EXPECT_EQ(SealFile(path_).error().kind, ErrorKind::kOutput);
}

}  // namespace
}  // namespace lf
