// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/yaml_schema.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

TEST(NumberRange, HoldsItsEndsUnlessOpen) {
  EXPECT_TRUE(NumberRange::Within(0, 1).Holds(0));
  EXPECT_TRUE(NumberRange::Within(0, 1).Holds(1));
  EXPECT_FALSE(NumberRange::Between(0, 1).Holds(0));
  EXPECT_FALSE(NumberRange::Between(0, 1).Holds(1));
  EXPECT_FALSE(NumberRange::Above(0).Holds(0));
  EXPECT_TRUE(NumberRange::AtLeast(0).Holds(0));
}

TEST(NumberRange, NoneHoldsWhatIsNoNumber) {
  for (const NumberRange& range : {NumberRange::Any(), NumberRange::AtLeast(0)}) {
    EXPECT_FALSE(range.Holds(std::nan("")));
    EXPECT_FALSE(range.Holds(HUGE_VAL));
  }
}

TEST(NumberRange, DescribesItself) {
  EXPECT_EQ(NumberRange::Above(0).Describe(), "above 0 (below 1e+09)");
  EXPECT_EQ(NumberRange::AtLeast(0).Describe(), "at least 0 (at most 1e+09)");
  EXPECT_EQ(NumberRange::Between(-90, 90).Describe(), "above -90 and below 90");
  EXPECT_EQ(NumberRange::Within(1, 3).Describe(), "from 1 to 3");
  EXPECT_EQ(NumberRange::Any().Describe(), "within +-1e+09");
}

TEST(YamlErrors, MisspeltKeysComeBeforeMissingOnes) {
  YamlErrors errors("p.yaml");
  errors.Add({1, 1}, "missing");
  errors.AddFirst({4, 2}, "misspelt");
  errors.AddFirst({5, 2}, "misspelt too");
  EXPECT_EQ(errors.First().message, "p.yaml:4:2: misspelt (also wrong: lines 1, 5)");
}

TEST(YamlErrors, ThereIsAnEndToThem) {
  YamlErrors errors("p.yaml");
  for (int i = 1; i < 1000; ++i) errors.Add({i, 1}, "wrong");
  EXPECT_TRUE(errors.full());
  EXPECT_LT(errors.First().message.size(), 200u);
}

TEST(YamlMap, AllowsTheKeysThatWereAskedFor) {
  const auto root = ParseYaml("a: 1\nb: 2\n", "p.yaml");
  YamlErrors errors("p.yaml");
  YamlMap map(**root, "top", &errors);
  EXPECT_NE(map.Find("a"), nullptr);
  EXPECT_EQ(map.Find("c"), nullptr);
  map.CheckKeys();
  EXPECT_EQ(errors.First().message, "p.yaml:2:1: unknown key 'b' in top; known are: a, c");
}

TEST(YamlMap, OneThatWasNotGivenHasNoKeys) {
  YamlErrors errors("p.yaml");
  YamlMap map("top", &errors);
  EXPECT_EQ(map.Find("a"), nullptr);
  map.CheckKeys();
  EXPECT_TRUE(errors.empty());
}

TEST(ReadBool, TakesTrueAndFalseOnly) {
  for (const char* text : {"true", "false", "yes", "'true'", "1"}) {
    YamlErrors errors("p.yaml");
    const auto root = ParseYaml(text, "p.yaml");
    const auto value = ReadBool(**root, "key", &errors);
    EXPECT_EQ(value.has_value(), (*root)->text.size() >= 4 && text[0] != '\'') << text;
    EXPECT_EQ(value.has_value(), errors.empty());
  }
}

}  // namespace
}  // namespace lf
