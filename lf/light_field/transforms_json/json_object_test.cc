// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_object.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {
namespace {

const std::filesystem::path kFile = "a.json";
constexpr NumberRule kAny = {"a number", [](double) { return true; }};

double NumberIn(const std::string& text) {
  JsonObject object;
  EXPECT_TRUE(object.Parse("{\"x\": " + text + "}")) << text;
  return JsonFields(object, kFile).Number("x", kAny)->value();
}

std::string TextIn(const std::string& text) {
  JsonObject object;
  EXPECT_TRUE(object.Parse("{\"x\": \"" + text + "\"}")) << text;
  return JsonFields(object, kFile).Text("x")->value();
}

bool IsObject(const std::string& text) { return JsonObject().Parse(text); }

TEST(JsonObject, NumbersAreTheNearestDoubles) {
  EXPECT_EQ(NumberIn("0.1000000000000000055511151231257827021181583404541015625"), 0.1);
  EXPECT_EQ(NumberIn("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(NumberIn("9007199254740993.0000000000000000001"), 9007199254740994.0);
  EXPECT_EQ(NumberIn("2.2250738585072011e-308"), 0x0.fffffffffffffp-1022);
  EXPECT_EQ(NumberIn("-1.7976931348623157e308"), -0x1.fffffffffffffp1023);
  EXPECT_EQ(NumberIn("1e-400"), 0);
}

TEST(JsonObject, IntegersMayHaveAnyLength) {
  EXPECT_EQ(NumberIn("18446744073709551615"), 0x1p64);
  EXPECT_EQ(NumberIn("-9223372036854775809"), -0x1p63);
  EXPECT_EQ(NumberIn("1267650600228229401496703205376"), 0x1p100);
}

TEST(JsonObject, StringsAreDecoded) {
  EXPECT_EQ(TextIn("\\u00e9\\t\\\"\\/\u00e9"), "\u00e9\t\"/\u00e9");
  EXPECT_EQ(TextIn("\\ud83d\\ude00\\uD55C"), "\U0001f600\ud55c");
}

TEST(JsonObject, OfEqualKeysTheLastCounts) {
  JsonObject object;
  ASSERT_TRUE(object.Parse(R"({"x": 1, "y": 2, "x": 3})"));
  EXPECT_EQ(JsonFields(object, kFile).Number("x", kAny)->value(), 3);
  ASSERT_TRUE(object.Parse(R"({"x": 1, "x": null})"));
  EXPECT_FALSE(JsonFields(object, kFile).Has("x"));
}

TEST(JsonObject, DeepNestingIsJson) {
  const auto nested = [](size_t depth) {
    return R"({"x": 1, "y": )" + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  for (const size_t depth : {10, 999, 1000, 1023, 1024, 1025, 100'000}) {
    JsonObject object;
    ASSERT_TRUE(object.Parse(nested(depth))) << depth;
    EXPECT_EQ(JsonFields(object, kFile).Number("x", kAny)->value(), 1);
  }
}

TEST(JsonObject, WhatIsNoObjectIsRefusedAndForgotten) {
  for (const std::string text : {"",
                                 "7",
                                 "[{}]",
                                 "{} {}",
                                 "{\"x\": 01}",
                                 "{\"x\": 1.}",
                                 "{\"x\": .5}",
                                 "{\"x\": +1}",
                                 "{\"x\": 1e999}",
                                 "{\"x\": NaN}",
                                 "{\"x\": 1,}",
                                 "{x: 1}",
                                 "{\"x\": '1'}",
                                 "{\"x\": \"\\ud800\"}",
                                 "{\"x\": \"\\udc00\"}",
                                 "{\"x\": \"\\ud83d\\u0041\"}",
                                 "{\"x\": \"\xff\"}",
                                 "{\"x\": \"\xed\xa0\x80\"}",
                                 "{\"x\": \"\n\"}",
                                 "{\"x\": \"\\q\"}",
                                 "{\"x\": 1 // one\n}"}) {
    EXPECT_FALSE(IsObject(text)) << text;
    JsonObject object;
    ASSERT_TRUE(object.Parse("{\"x\": 1}"));
    EXPECT_FALSE(object.Parse(text)) << text;
    EXPECT_FALSE(JsonFields(object, kFile).Has("x"));
  }
}

}  // namespace
}  // namespace lf
