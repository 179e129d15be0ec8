// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/spelling.h"

#include <gtest/gtest.h>

#include <vector>

namespace lf {
namespace {

TEST(Spelling, CountsChangedAddedLostAndSwappedLetters) {
  EXPECT_EQ(EditDistance("frames", "frames"), 0u);
  EXPECT_EQ(EditDistance("frames", "franes"), 1u);
  EXPECT_EQ(EditDistance("frames", "frame"), 1u);
  EXPECT_EQ(EditDistance("frames", "framess"), 1u);
  EXPECT_EQ(EditDistance("frames", "farmes"), 1u);
  EXPECT_EQ(EditDistance("", "fps"), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
}

TEST(Spelling, FindsTheWordThatWasMeant) {
  const std::vector<std::string> words{"focal_length", "focal_length_mm", "focus_distance"};
  EXPECT_EQ(NearestWord("focal_lenght", words), "focal_length");
  EXPECT_EQ(NearestWord("focal_lenght_mm", words), "focal_length_mm");
  EXPECT_EQ(NearestWord("colour", words), "");
  EXPECT_EQ(NearestWord("", words), "");
  EXPECT_EQ(NearestWord(std::string(100'000, 'f'), words), "");
}

}  // namespace
}  // namespace lf
