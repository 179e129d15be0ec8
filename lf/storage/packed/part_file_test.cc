// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/part_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "lf/core/file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

class PartFileTest : public ::testing::Test {
 protected:
  PartFileTest()
      : path_(fs::temp_directory_path() /
              ("lf_part_test." + std::to_string(::getpid()) + "." +
               ::testing::UnitTest::GetInstance()->current_test_info()->name())) {}
  ~PartFileTest() override { fs::remove(path_); }

  static std::string FaultOf(const Result<PartReader>& part) {
    EXPECT_FALSE(part);
    return part ? "" : part.error().message;
  }

  fs::path path_;
};

TEST_F(PartFileTest, RangesAreReadAsTheyWereWritten) {
  ImageRanges ranges;
  ranges.mask = {700, 3, UINT64_MAX};
  ranges.pieces = {{64, 10, 1}, {5, 0, 2}, {uint64_t{1} << 40, 1 << 30, 3}};
  const std::string text = TextOfRanges(ranges);
  const std::optional<ImageRanges> read = RangesOfText(text, 3);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->pieces.size(), 3u);
  EXPECT_EQ(TextOfRanges(*read), text);
  EXPECT_EQ(read->mask.hash, UINT64_MAX);
  EXPECT_EQ(read->pieces[2].end(), (uint64_t{1} << 40) + (1 << 30));
  EXPECT_FALSE(RangesOfText(text, 2));
  EXPECT_FALSE(RangesOfText(text.substr(0, 24), 3));
  EXPECT_FALSE(RangesOfText(text.substr(1), 3));
  ranges.pieces[1].begin = UINT64_MAX;
  EXPECT_FALSE(RangesOfText(TextOfRanges(ranges), 3));
}

TEST_F(PartFileTest, TheLastPieceIsInTheLastPart) {
  ImageRanges ranges;
  ranges.pieces.resize(4);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(ranges.PartOf(i, 4), i);
  ranges.pieces.resize(2);
  EXPECT_EQ(ranges.PartOf(0, 4), 0u);
  EXPECT_EQ(ranges.PartOf(1, 4), 3u);
  ranges.pieces.resize(1);
  EXPECT_EQ(ranges.PartOf(0, 4), 0u);
}

TEST_F(PartFileTest, WhatWasNotCommittedIsDropped) {
  PartRange first, second;
  uint64_t committed = 0;
  {
    PartWriter writer = PartWriter::Open(path_, "0123456789abcdef", 2, 0).value();
    first = writer.Add("one").value();
    ASSERT_TRUE(writer.Flush());
    committed = writer.bytes();
    EXPECT_EQ(committed, kPartHeadBytes + 3);
    second = writer.Add("lost").value();
  }
  EXPECT_EQ(StoreOfPart(path_), "0123456789abcdef");
  {
    PartWriter writer = PartWriter::Open(path_, "0123456789abcdef", 2, committed).value();
    second = writer.Add("two").value();
    EXPECT_EQ(second.begin, committed);
  }
  const PartReader reader = PartReader::Open(path_, "0123456789abcdef", 2).value();
  EXPECT_EQ(reader.bytes(), kPartHeadBytes + 6);
  std::string bytes;
  ASSERT_TRUE(reader.Read(first, &bytes));
  ASSERT_TRUE(reader.Read(second, &bytes));
  EXPECT_EQ(bytes, "onetwo");
  const auto longer = PartWriter::Open(path_, "0123456789abcdef", 2, 1000);
  ASSERT_FALSE(longer);
  EXPECT_NE(longer.error().message.find("has 70 bytes, but 1000 were written"), std::string::npos);
}

TEST_F(PartFileTest, DamageAndOtherPartsAreErrors) {
  PartRange range;
  {
    PartWriter writer = PartWriter::Open(path_, "0123456789abcdef", 0, 0).value();
    range = writer.Add("some bytes").value();
  }
  EXPECT_NE(FaultOf(PartReader::Open(path_, "0123456789abcdef", 1)).find("is not part 1"),
            std::string::npos);
  EXPECT_NE(FaultOf(PartReader::Open(path_, "f123456789abcdef", 0)).find("is not part 0"),
            std::string::npos);
  EXPECT_NE(FaultOf(PartReader::Open("/nowhere", "f", 0)).find("No such file"), std::string::npos);
  EXPECT_NE(FaultOf(PartReader::Open("/", "f", 0)).find("no regular file"), std::string::npos);
  const auto fault = [&](const std::string& file) {
    EXPECT_TRUE(WriteFileAtomically(path_, file));
    std::string bytes;
    const auto read = PartReader::Open(path_, "0123456789abcdef", 0).value().Read(range, &bytes);
    return read ? std::string() : read.error().message;
  };
  const std::string file = *ReadFile(path_);
  EXPECT_EQ(fault(file), "");
  EXPECT_NE(fault(file.substr(0, file.size() - 1)).find("the copy is incomplete"),
            std::string::npos);
  EXPECT_NE(fault(file.substr(0, 20)).find("the copy is incomplete"), std::string::npos);
  EXPECT_NE(fault(file.substr(0, file.size() - 1) + "x").find("a wrong checksum"),
            std::string::npos);
  EXPECT_EQ(StoreOfPart("/nowhere"), "");
  EXPECT_EQ(StoreOfPart("/"), "");
}

}  // namespace
}  // namespace lf
