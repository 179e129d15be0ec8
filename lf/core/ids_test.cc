// SPDX-License-Identifier: Apache-2.0
#include "lf/core/ids.h"

#include <gtest/gtest.h>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

TEST(FrameNumbers, CountFromTheFirst) {
  const FrameNumbers frames = {1001, 3};
  EXPECT_EQ(frames.last(), 1003u);
  EXPECT_EQ(frames.All(), (std::vector<FrameId>{{1001}, {1002}, {1003}}));
  for (size_t i = 0; i < frames.count; ++i) EXPECT_EQ(frames.IndexOf(frames.At(i)), i);
  for (const uint32_t number : {0u, 1u, 1000u, 1004u, 4294967295u})
    EXPECT_FALSE(frames.Has({number})) << number;
  EXPECT_TRUE((FrameNumbers{0, 1}).Has({0}));
  EXPECT_TRUE(FrameNumbers().All().empty());
}

TEST(FrameNumbers, AreReadWithinTheirLimit) {
  EXPECT_EQ(ParseFrameNumber("0001"), 1u);
  EXPECT_EQ(ParseFrameNumber("0"), 0u);
  EXPECT_EQ(ParseFrameNumber("99999999"), 99999999u);
  for (const char* text : {"", "-1", "100000000", "1.0", "7 ", "x"})
    EXPECT_FALSE(ParseFrameNumber(text)) << text;
}

}  // namespace
}  // namespace lf
