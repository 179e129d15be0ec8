// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/raw_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "lf/core/random.h"
#include "lf/pixels/files/test_byte_source.h"

namespace lf {
namespace {

TEST(RawStream, GivesTheBytesOfTheFileHoweverTheyAreRead) {
  std::string bytes(200'000, '\0');
  uint64_t i = 0;
  for (char& byte : bytes) byte = static_cast<char>(RandomBits(1, 2, i++));
  const ByteSource source = SourceOf(bytes);
  RawStream stream(source, bytes.size());
  std::string read(bytes.size(), '\0');
  for (int step = 0; step < 2000; ++step) {
    const uint64_t random = RandomBits(3, 4, static_cast<uint64_t>(step));
    const size_t offset = random % bytes.size();
    const size_t count = (random >> 32) % (step % 10 == 0 ? 100'000 : 50) + 1;
    if (step % 3 > 0) stream.seek(static_cast<INT64>(offset), SEEK_SET);
    const auto begin = static_cast<size_t>(stream.tell());
    const size_t expected = std::min(count, bytes.size() - begin);
    if (step % 2 == 0) {
      ASSERT_EQ(stream.read(read.data(), 1, count), static_cast<int>(expected));
      ASSERT_EQ(read.substr(0, expected), bytes.substr(begin, expected));
    } else {
      for (size_t k = 0; k < expected; ++k)
        ASSERT_EQ(stream.get_char(), static_cast<uint8_t>(bytes[begin + k]));
    }
    ASSERT_EQ(stream.tell(), static_cast<INT64>(begin + expected));
    ASSERT_EQ(stream.eof(), begin + expected == bytes.size());
  }
}

TEST(RawStream, NotesWhatIsSoughtBeyondTheEndButNotReadingUpToIt) {
  const std::string bytes = "0123456789";
  const ByteSource source = SourceOf(bytes);
  RawStream stream(source, bytes.size());
  std::string read(20, '\0');
  EXPECT_EQ(stream.read(read.data(), 4, 5), 2);  // only whole elements are counted
  EXPECT_EQ(stream.get_char(), -1);
  EXPECT_FALSE(stream.ReadBeyondEnd());
  stream.seek(10, SEEK_SET);
  EXPECT_FALSE(stream.ReadBeyondEnd());
  EXPECT_EQ(stream.read(read.data(), 1, 1), 0);
  EXPECT_TRUE(stream.ReadBeyondEnd());
  stream.ForgetReadBeyondEnd();
  stream.seek(INT64_MAX, SEEK_SET);
  EXPECT_EQ(stream.get_char(), -1);
  EXPECT_TRUE(stream.ReadBeyondEnd());
  stream.seek(-5, SEEK_SET);
  EXPECT_EQ(stream.tell(), 0);
  stream.seek(-1, SEEK_END);
  EXPECT_EQ(stream.get_char(), '9');
}

TEST(RawStream, LinesAndNumbersAreReadAsText) {
  const std::string bytes = "first\n 12 3.5\n";
  const ByteSource source = SourceOf(bytes);
  RawStream stream(source, bytes.size());
  char line[5];
  EXPECT_STREQ(stream.gets(line, sizeof line), "firs");
  EXPECT_STREQ(stream.gets(line, sizeof line), "t\n");
  int whole = 0;
  float fraction = 0;
  EXPECT_EQ(stream.scanf_one("%d", &whole), 1);
  EXPECT_EQ(stream.scanf_one("%f", &fraction), 1);
  EXPECT_EQ(whole, 12);
  EXPECT_EQ(fraction, 3.5f);
  EXPECT_EQ(stream.scanf_one("%d", &whole), EOF);
  EXPECT_EQ(stream.gets(line, sizeof line), nullptr);
}

}  // namespace
}  // namespace lf
