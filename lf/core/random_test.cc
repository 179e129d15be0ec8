// SPDX-License-Identifier: Apache-2.0
#include "lf/core/random.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(Random, IsUniformInTheUnitInterval) {
  int count[10] = {};
  for (uint64_t i = 0; i < 100000; ++i) {
    const double u = RandomUnit(1, 2, i);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++count[static_cast<int>(u * 10)];
  }
  for (const int c : count) EXPECT_NEAR(c, 10000, 500);
}

TEST(Random, SeedsStreamsAndIndicesAllMatter) {
  EXPECT_NE(RandomBits(1, 2, 3), RandomBits(2, 2, 3));
  EXPECT_NE(RandomBits(1, 2, 3), RandomBits(1, 3, 3));
  EXPECT_NE(RandomBits(1, 2, 3), RandomBits(1, 2, 4));
  EXPECT_EQ(RandomBits(1, 2, 3), RandomBits(1, 2, 3));
}

}  // namespace
}  // namespace lf
