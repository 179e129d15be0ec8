// SPDX-License-Identifier: Apache-2.0
#include "lf/core/parse_number.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace lf {
namespace {

TEST(ParseNumber, TakesWholeFiniteDecimalNumbersOnly) {
  EXPECT_EQ(ParseNumber("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(ParseNumber("+7"), 7);
  EXPECT_EQ(ParseNumber(".5"), 0.5);
  for (const char* text : {"", "+", "-", "+-1", "--1", " 1", "1 ", "1,5", "0x10", "nan", "inf",
                           "-infinity", "1e999", "1e", "abc"})
    EXPECT_FALSE(ParseNumber(text)) << text;
}

TEST(ParseRate, TakesNumbersAndFractions) {
  EXPECT_EQ(ParseRate("23.976"), 23.976);
  EXPECT_EQ(ParseRate("24000/1001"), 24000.0 / 1001);
  EXPECT_EQ(ParseRate("25/1"), 25);
  for (const char* text : {"", "/", "24/", "/1001", "24/0", "24/1/1", "24 / 1", "1e300/1e-300"})
    EXPECT_FALSE(ParseRate(text)) << text;
}

TEST(ParseWhole, TakesWholeDecimalNumbersThatFitOnly) {
  EXPECT_EQ(ParseWhole<uint32_t>("0"), 0u);
  EXPECT_EQ(ParseWhole<uint32_t>("010"), 10u);
  EXPECT_EQ(ParseWhole<int>("-7"), -7);
  EXPECT_EQ(ParseWhole<uint64_t>("18446744073709551615"), UINT64_MAX);
  for (const char* text : {"", " ", "abc", "0x0", "0.9", "1e3", "+5", " 5", "5 ", "5\n", "1,000",
                           "1 2", "nan", "-", "4294967296", "-1"})
    EXPECT_FALSE(ParseWhole<uint32_t>(text)) << text;
  EXPECT_FALSE(ParseWhole<int>("2147483648"));
}

}  // namespace
}  // namespace lf
