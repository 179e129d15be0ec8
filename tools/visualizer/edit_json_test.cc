// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/edit_json.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(EditJson, KeysOfEditsAreKept) {
  EXPECT_EQ(
      ReadEdit(R"({"text": "a\nb", "frame": 7, "x": -1.5, "force": true, "camera": null})").dump(),
      R"({"text":"a\nb","frame":7,"x":-1.5,"force":true,"camera":null})");
  EXPECT_EQ(ReadEdit("{}").dump(), "{}");
}

TEST(EditJson, OtherKeysAreLeftOut) {
  EXPECT_EQ(ReadEdit(R"({"text": "a", "": 1, "Text": 2, "more": "b", "x": 3})").dump(),
            R"({"text":"a","x":3})");
}

TEST(EditJson, TheLastOfEqualKeysCounts) {
  EXPECT_EQ(ReadEdit(R"({"x": 1, "x": "two"})").dump(), R"({"x":"two"})");
}

TEST(EditJson, OtherTextsAreNoObjects) {
  for (const char* text : {"", "7", "null", "\"text\"", "[]", "[{}]", "{", "{}{}", "{} x",
                           R"({"x": })", R"({"x": [1]})", R"({"x": {}})", R"({"more": [1]})",
                           R"({"more": {"x": 1}})", R"({"x": 1)", "{\"text\": \"\xff\"}"})
    EXPECT_FALSE(ReadEdit(text).is_object()) << text;
}

}  // namespace
}  // namespace lf
