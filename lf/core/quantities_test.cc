// SPDX-License-Identifier: Apache-2.0
#include "lf/core/quantities.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(ByteSize, ReadsMemoryAsPeopleWriteIt) {
  EXPECT_EQ(*ParseByteSize("4096", "{memory}"), 4096u);
  EXPECT_EQ(*ParseByteSize("8G", "{memory}"), size_t{8} << 30);
  EXPECT_EQ(*ParseByteSize("512MB", "{memory}"), size_t{512} << 20);
  EXPECT_EQ(*ParseByteSize("1.5g", "{memory}"), size_t{3} << 29);
}

TEST(ByteSize, RefusesTheRestAndNamesTheOption) {
  for (const char* text :
       {"", "G", "-1G", "8 G", "8X", "0", "8GiB", "1e30", "nan", "0x10G", "1048576T"}) {
    const Result<size_t> size = ParseByteSize(text, "{memory}");
    ASSERT_FALSE(size) << text;
    EXPECT_EQ(size.error().kind, ErrorKind::kUsage);
    EXPECT_NE(size.error().message.find("{memory}"), std::string::npos);
  }
}

TEST(Duration, ReadsTimesAsPeopleWriteThem) {
  EXPECT_EQ(*ParseDuration("30s", "{dump_every}"), 30);
  EXPECT_EQ(*ParseDuration("45", "{dump_every}"), 45);
  EXPECT_EQ(*ParseDuration("10m", "{dump_every}"), 600);
  EXPECT_EQ(*ParseDuration("1.5h", "{dump_every}"), 5400);
  EXPECT_EQ(*ParseDuration("0", "{dump_every}"), 0);
  for (const char* text :
       {"", "s", "-1s", "30 s", "30S", "1d", "1e30", "nan", "99999999h", "1.2.3s", "."}) {
    const Result<double> time_s = ParseDuration(text, "{dump_every}");
    ASSERT_FALSE(time_s) << text;
    EXPECT_EQ(time_s.error().kind, ErrorKind::kUsage);
    EXPECT_NE(time_s.error().message.find("{dump_every}"), std::string::npos);
  }
}

TEST(Count, ReadsNumbersOfThingsAsPeopleWriteThem) {
  EXPECT_EQ(*ParseCount("0", "{max_rays}"), 0u);
  EXPECT_EQ(*ParseCount("250000", "{max_rays}"), 250'000u);
  EXPECT_EQ(*ParseCount("250k", "{max_rays}"), 250'000u);
  EXPECT_EQ(*ParseCount("3M", "{max_rays}"), 3'000'000u);
  EXPECT_EQ(*ParseCount("1.5g", "{max_rays}"), 1'500'000'000u);
  for (const char* text : {"", "M", "-1", "+1", "1.5", "3 M", "3Mi", "3MB", "3e6", "0x3", "nan",
                           "1.2.3M", "1.0005k", "99999T"}) {
    const Result<uint64_t> count = ParseCount(text, "{max_rays}");
    ASSERT_FALSE(count) << text;
    EXPECT_EQ(count.error().kind, ErrorKind::kUsage);
    EXPECT_NE(count.error().message.find("{max_rays}"), std::string::npos);
  }
}

TEST(ShortText, NumbersAndDurationsAreShort) {
  EXPECT_EQ(ShortNumber(0), "0 ");
  EXPECT_EQ(ShortNumber(1234), "1.23 k");
  EXPECT_EQ(ShortNumber(4.56e9), "4.56 G");
  EXPECT_EQ(ShortDuration(14.4), "14 s");
  EXPECT_EQ(ShortDuration(125), "2 min 5 s");
  EXPECT_EQ(ShortDuration(3 * 3600 + 20 * 60 + 59), "3 h 20 min");
  EXPECT_EQ(ShortDuration(-1), "0 s");
}

}  // namespace
}  // namespace lf
