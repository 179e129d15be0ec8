// SPDX-License-Identifier: Apache-2.0
#include "lf/core/hash.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

TEST(Hash, IsXxh3) {
  EXPECT_EQ(HashBytes(""), 0x2d06800538d394c2u);  // from the specification of XXH3
  EXPECT_NE(HashBytes("", 1), HashBytes(""));
  EXPECT_NE(HashBytes("frame 1"), HashBytes("frame 2"));
}

TEST(Hash, PartsGiveTheHashOfTheWhole) {
  std::string whole;
  Hasher hasher;
  for (int i = 0; i < 1000; ++i) {
    const std::string part(static_cast<size_t>(i % 37), static_cast<char>(i));
    whole += part;
    hasher.Add(part);
  }
  EXPECT_EQ(hasher.Hash(), HashBytes(whole));
}

}  // namespace
}  // namespace lf
