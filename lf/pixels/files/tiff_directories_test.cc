// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/tiff_directories.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/pixels/files/test_byte_source.h"

namespace lf {
namespace {
using namespace std::string_literals;

TEST(TiffDirectories, NumbersOfAllTypesAreRead) {
  const std::string file =
      "MM\0*\0\0\0\x08\0\5"
      "\0\1\0\3\0\0\0\2\1\2\3\4"      // two shorts in place
      "\0\2\0\5\0\0\0\1\0\0\0\x4a"    // a fraction at 74
      "\0\3\0\x0a\0\0\0\1\0\0\0\x52"  // a signed fraction at 82
      "\0\4\0\2\0\0\0\2ab\0\0"        // text
      "\0\5\0\1\0\0\0\4\1\2\3\xff"
      "\0\0\0\0"
      "\0\0\0\7\0\0\0\2"
      "\xff\xff\xff\xfd\0\0\0\4"s;
  const ByteSource source = SourceOf(file);
  const auto first = FirstTiffDirectory(source);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->Numbers(1, 2), (std::vector<double>{0x102, 0x304}));
  EXPECT_EQ(first->Numbers(1, 1), std::vector<double>{});  // two values, more than the limit
  EXPECT_EQ(first->Numbers(2, 1), std::vector<double>{3.5});
  EXPECT_EQ(first->Numbers(3, 1), std::vector<double>{-0.75});
  EXPECT_EQ(first->Numbers(4, 9), std::vector<double>{});
  EXPECT_EQ(first->Numbers(5, 4), (std::vector<double>{1, 2, 3, 255}));
  EXPECT_EQ(first->Number(6, 17), 17);
  EXPECT_TRUE(first->Has(4));
  EXPECT_FALSE(first->Has(6));
}

TEST(TiffDirectories, BigTiffIsRead) {
  const std::string file =
      "MM\0+\0\x08\0\0\0\0\0\0\0\0\0\x10"
      "\0\0\0\0\0\0\0\4"
      "\0\1\0\3\0\0\0\0\0\0\0\4\0\1\0\2\0\3\0\4"    // four shorts in place
      "\0\2\0\3\0\0\0\0\0\0\0\5\0\0\0\0\0\0\0\x68"  // five shorts at 104
      "\0\3\0\x11\0\0\0\0\0\0\0\1\xff\xff\xff\xff\xff\xff\xff\xfe"
      "\0\4\0\x10\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0\0\0\0\0"
      "\0\5\0\6\0\7\0\x08\0\x09"s;
  const ByteSource source = SourceOf(file);
  const auto first = FirstTiffDirectory(source);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->Numbers(1, 4), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(first->Numbers(2, 5), (std::vector<double>{5, 6, 7, 8, 9}));
  EXPECT_EQ(first->Numbers(3, 1), std::vector<double>{-2});
  EXPECT_EQ(first->Numbers(4, 9), std::vector<double>{});
}

TEST(TiffDirectories, WhatLiesBeyondTheEndIsMissing) {
  const std::string file = "II*\0\x08\0\0\0\xff\xff\1\0\3\0\4\0\0\0\xff\xff\xff\xff\2\0\3\0"s;
  const ByteSource source = SourceOf(file);
  const std::optional<TiffDirectory> first = FirstTiffDirectory(source);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->Has(1));
  EXPECT_EQ(first->Numbers(1, 4), std::vector<double>{});
  EXPECT_FALSE(first->Has(2));
  const std::string big_tiff = "II+\0\x08\0\0\0\x10\0\0\0\0\0\0\0"s, none = "II*\0\0\0\0\0"s;
  EXPECT_FALSE(FirstTiffDirectory(SourceOf(big_tiff)));
  EXPECT_FALSE(FirstTiffDirectory(SourceOf(none)));
}

}  // namespace
}  // namespace lf
