// SPDX-License-Identifier: Apache-2.0
#include "lf/core/byte_stream.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lf/core/file.h"
#include "lf/core/random.h"

namespace lf {
namespace {
namespace fs = std::filesystem;

class ByteStreamTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("lf_byte_stream_test." + std::to_string(::getpid()) + "." +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

std::string Noise(size_t size) {
  std::string bytes(size, '\0');
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(RandomBits(3, 4, i));
  return bytes;
}

// Skips steps of many sizes. Some of them cross the end of a block.
TEST_F(ByteStreamTest, AFileIsTheSameAsItsBytesInMemory) {
  const std::string bytes = Noise((size_t{5} << 20) + 123);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "noise", bytes));
  Result<ByteStream> file = ByteStream::Open(folder_ / "noise");
  ASSERT_TRUE(file) << file.error().message;
  ByteStream memory(bytes, "memory");
  for (uint64_t i = 0; memory.remaining() > 0; ++i) {
    ASSERT_EQ(file->position(), memory.position());
    uint64_t a = 0, b = 0;
    ASSERT_EQ(file->Take(&a), memory.Take(&b));
    ASSERT_EQ(a, b);
    const std::string_view window = file->Window();
    ASSERT_EQ(window.empty(), memory.remaining() == 0);
    ASSERT_EQ(window, memory.Window().substr(0, window.size()));
    const uint64_t most = i % 50 == 0 ? uint64_t{1} << 21 : 7000;
    const uint64_t step = std::min(RandomBits(1, 2, i) % most, memory.remaining());
    file->Skip(step);
    memory.Skip(step);
  }
  EXPECT_EQ(file->remaining(), 0u);
  EXPECT_TRUE(file->Window().empty());
  EXPECT_TRUE(file->Status());
}

TEST_F(ByteStreamTest, TooFewBytesAreNotTaken) {
  ByteStream stream("abcdefg", "name");
  uint64_t eight = 0;
  EXPECT_FALSE(stream.Take(&eight));
  EXPECT_EQ(stream.remaining(), 7u);
  char one = 0;
  EXPECT_TRUE(stream.Take(&one));
  EXPECT_EQ(one, 'a');
}

TEST_F(ByteStreamTest, AFileThatShrinksMeanwhileIsAnError) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", Noise(size_t{3} << 20)));
  Result<ByteStream> stream = ByteStream::Open(folder_ / "file");
  ASSERT_TRUE(stream);
  fs::resize_file(folder_ / "file", 1000);
  stream->Skip(size_t{2} << 20);
  EXPECT_TRUE(stream->Window().empty());
  ASSERT_FALSE(stream->Status());
  EXPECT_NE(stream->Status().error().message.find("shorter"), std::string::npos);
}

TEST_F(ByteStreamTest, WhatIsNoFileIsAnErrorAtOnce) {
  EXPECT_FALSE(ByteStream::Open(folder_));
  EXPECT_FALSE(ByteStream::Open(folder_ / "none"));
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(ByteStream::Open(folder_ / "pipe"));  // a pipe that nobody writes to
}

}  // namespace
}  // namespace lf
