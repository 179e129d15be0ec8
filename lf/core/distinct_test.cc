// SPDX-License-Identifier: Apache-2.0
#include "lf/core/distinct.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

// Gives many different values the same hash.
uint64_t HashOf(const uint64_t& value) { return value % 7; }

TEST(Distinct, ListsValuesAsTheyFirstCame) {
  Distinct<uint64_t, HashOf> distinct;
  EXPECT_EQ(distinct.IndexOf(50), 0u);
  EXPECT_EQ(distinct.IndexOf(1), 1u);
  EXPECT_EQ(distinct.IndexOf(50), 0u);
  EXPECT_EQ(distinct.IndexOf(8), 2u);
  EXPECT_EQ(distinct.size(), 3u);
  EXPECT_EQ(distinct.Take(), (std::vector<uint64_t>{50, 1, 8}));
  EXPECT_EQ(distinct.size(), 0u);
  EXPECT_EQ(distinct.IndexOf(8), 0u);
}

TEST(Distinct, EveryValueIsFoundWhereItIsListed) {
  Distinct<uint64_t, HashOf> distinct;
  std::vector<uint64_t> values;
  std::vector<uint32_t> indices;
  for (uint64_t i = 0; i < 3000; ++i) {
    values.push_back(RandomBits(1, 2, i) % 500);
    indices.push_back(distinct.IndexOf(values.back()));
  }
  const std::vector<uint64_t> list = distinct.Take();
  EXPECT_LE(list.size(), 500u);
  for (size_t i = 0; i < values.size(); ++i) EXPECT_EQ(list[indices[i]], values[i]);
}

}  // namespace
}  // namespace lf
