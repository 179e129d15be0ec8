// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/stop_rules.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(StopRules, AreReadAndWritten) {
  EXPECT_EQ(ParseStopRule("samples>=8", "{require}")->samples, 8u);
  EXPECT_EQ(ParseStopRule("samples>=16777215", "{require}")->samples, 16777215u);
  EXPECT_EQ(ParseStopRule("noise<=0.002", "{stop_when}")->noise, 0.002);
  EXPECT_EQ(ParseStopRule("noise<=2e-3", "{stop_when}")->noise, 0.002);
  EXPECT_EQ(ParseStopRule("noise<=1000", "{stop_when}")->noise, 1000);
  EXPECT_EQ(ParseStopRule(TextOf({.noise = 1.0 / 3}), "{stop_when}")->noise, 1.0 / 3);
  EXPECT_EQ(TextOf({.samples = 12}), "samples>=12");
  const StopRule none = *ParseStopRule("", "{stop_when}");
  EXPECT_FALSE(none.samples || none.noise);
  EXPECT_EQ(TextOf(none), "");
}

TEST(StopRules, AnythingElseIsRefusedWithTheNameOfTheSetting) {
  for (const char* text :
       {"noise",       "noise<=",    "noise<0.1",  "noise>=0.1",  "noise<=0",
        "noise<=-1",   "noise<=nan", "noise<=inf", "noise<=1001", "noise<=0.1x",
        "noise<= 0.1", "8",          "samples>8",  "samples>=0",  "samples>=-1",
        "samples>=8x", "rays>=8",    " ",          "samples>= 8", "samples>=16777216"}) {
    const Result<StopRule> rule = ParseStopRule(text, "{require}");
    ASSERT_FALSE(rule) << text;
    EXPECT_EQ(rule.error().kind, ErrorKind::kUsage);
    EXPECT_NE(rule.error().message.find("{require}"), std::string::npos);
  }
}

}  // namespace
}  // namespace lf
