// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/path_kind.h"

#include <gtest/gtest.h>

#include "lf/import/paths/test_paths.h"

namespace lf {
namespace {

using Keys = std::vector<std::string>;

TEST(PathKind, KeysOfTheTopLevelAreFoundBetweenOthersAndInBrokenText) {
  EXPECT_EQ(TopLevelKeys(R"( {"a": {"b": 1}, "c\"d": ["e", {"f": "g"}], "h" : "i:"})"),
            (Keys{"a", "c\\\"d", "h"}));
  EXPECT_EQ(TopLevelKeys("{\"a\": [1, 2"), Keys{"a"});
  EXPECT_EQ(TopLevelKeys("{\"a\": \"unfinished"), Keys{"a"});
  EXPECT_EQ(TopLevelKeys("{\"a\\"), Keys{});
  EXPECT_EQ(TopLevelKeys("[{\"a\": 1}]"), Keys{});
  EXPECT_EQ(TopLevelKeys(""), Keys{});
}

TEST(PathKind, TheContentTellsTheForm) {
  const auto kind = [](std::string_view text) {
    const Result<PathKind> found = PathKindOf(text, "p");
    EXPECT_TRUE(found) << text;
    return found ? *found : PathKind::kYaml;
  };
  EXPECT_EQ(kind(kNerfstudioText), PathKind::kNerfstudio);
  EXPECT_EQ(kind("\xEF\xBB\xBF" + kNgpText), PathKind::kNgp);
  EXPECT_EQ(kind("format: lfpath 1\n"), PathKind::kYaml);
  EXPECT_EQ(kind("{format: lfpath 1}"), PathKind::kYaml);
  EXPECT_EQ(kind(R"({"format": "lfpath 1"})"), PathKind::kYaml);
  EXPECT_EQ(kind(""), PathKind::kYaml);
  EXPECT_EQ(kind("# nothing"), PathKind::kYaml);
  EXPECT_EQ(kind("# of Nuke\n\n  1\t0 0 0 0 0 0\n"), PathKind::kChan);
  EXPECT_EQ(kind("-3 1"), PathKind::kChan);
}

TEST(PathKind, FilesOfOurOwnAndUsdAreRefusedByName) {
  ExpectPathError(PathKindOf("SQLite format 3", "p"), "p",
                  {"packed store", "not read as a camera path"});
  ExpectPathError(PathKindOf("#usda 1.0\n(", "p"), "p", {"USD", "not read", "camera path"});
}

TEST(PathKind, TextInUtf16IsRefusedUnlessItIsOurOwn) {
  const auto utf16 = [](std::string_view text, bool is_big) {
    std::string wide = is_big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : text) wide += is_big ? std::string{'\0', c} : std::string{c, '\0'};
    return wide;
  };
  for (const bool is_big : {false, true}) {
    for (const std::string& text : {kNerfstudioText, std::string("1 0 0 0 0 0 0\n")})
      ExpectPathError(PathKindOf(utf16(text, is_big), "p"), "p", {"UTF-16", "save it as UTF-8"});
    EXPECT_EQ(*PathKindOf(utf16("format: lfpath 1\n", is_big), "p"), PathKind::kYaml);
  }
}

TEST(PathKind, OtherJsonIsRefusedWithTheKeysFound) {
  ExpectPathError(PathKindOf(R"({"cameras": [], "x": {"path": []}})", "p"), "p",
                  {"found 'cameras', 'x'", "camera_path"});
  ExpectPathError(PathKindOf("[]", "p"), "p", {"found no key"});
}

}  // namespace
}  // namespace lf
