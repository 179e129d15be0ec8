// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/dump_clock.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(DumpClock, IsDueAfterAnInterval) {
  DumpClock clock(30, 1000);
  EXPECT_FALSE(clock.IsDue(1029));
  EXPECT_TRUE(clock.IsDue(1030));
  EXPECT_FALSE(clock.Done(1030, 1031));  // 1 s of 31 s is less than 5 %
  EXPECT_FALSE(clock.IsDue(1060));
  EXPECT_TRUE(clock.IsDue(1061));
}

TEST(DumpClock, StretchesSoThatCheckpointsTakeAtMostOneTwentieth) {
  DumpClock clock(30, 0);
  EXPECT_TRUE(clock.Done(30, 40));  // true: the interval is longer
  EXPECT_DOUBLE_EQ(clock.interval_s(), 190);
  EXPECT_FALSE(clock.IsDue(40 + 189));
  EXPECT_TRUE(clock.IsDue(40 + 190.001));
  EXPECT_FALSE(clock.Done(230, 240));  // false: the user knows already
  EXPECT_FALSE(clock.Done(430, 431));  // a fast checkpoint restores 30 s
  EXPECT_DOUBLE_EQ(clock.interval_s(), 30);
  EXPECT_TRUE(clock.Done(461, 491));
}

TEST(DumpClock, ZeroIsNever) {
  const DumpClock clock(0, 0);
  EXPECT_FALSE(clock.IsDue(1e9));
}

}  // namespace
}  // namespace lf
