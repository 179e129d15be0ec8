// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_layout.h"

#include <gtest/gtest.h>

#include <set>

namespace lf {
namespace {

std::string Path(const std::string& out, const ViewFileName& name) {
  const auto path = PathOfViews(out, name);
  return path ? path->string() : path.error().message;
}

TEST(ViewLayout, NamesAreParsed) {
  for (const char* name : {"quilt", "side-by-side", "over-under", "anaglyph", "left-right"})
    EXPECT_STREQ(NameOf(ParseViewLayout(name).value()), name);
  EXPECT_FALSE(ParseViewLayout("toe-in"));
}

TEST(ViewLayout, AQuiltBeginsAtTheLowerLeftAndEndsAtTheUpperRight) {
  const TileCounts grid = {3, 2};
  std::set<std::pair<int, int>> places;
  for (int view = 0; view < 6; ++view) {
    const ViewTile tile = TileOf(ViewLayout::kQuilt, grid, view);
    places.insert({tile.column, tile.row});
    EXPECT_EQ(tile.column, view % 3);
    EXPECT_EQ(tile.row, view < 3 ? 1 : 0);
  }
  EXPECT_EQ(places.size(), 6u);
}

TEST(ViewLayout, TheLeftEyeIsOnTheLeftAndAbove) {
  EXPECT_EQ(TileOf(ViewLayout::kSideBySide, {}, 0).column, 0);
  EXPECT_EQ(TileOf(ViewLayout::kSideBySide, {}, 1).column, 1);
  EXPECT_EQ(TileOf(ViewLayout::kOverUnder, {}, 0).row, 0);
  EXPECT_EQ(TileOf(ViewLayout::kOverUnder, {}, 1).row, 1);
}

TEST(ViewLayout, NamesOfQuiltsEndWithColumnsRowsAndAspectOfOneView) {
  EXPECT_EQ(Path("out/film.png", {ViewLayout::kQuilt, {8, 6}, 1920, 1080}),
            "out/film_qs8x6a1.78.png");
  EXPECT_EQ(Path("film.mp4", {ViewLayout::kQuilt, {8, 6}, 420, 560}), "film_qs8x6a0.75.mp4");
  EXPECT_EQ(Path("film.png", {ViewLayout::kQuilt, {8, 6}, 420, 560, 12}),
            "film_0012_qs8x6a0.75.png");
  EXPECT_EQ(Path("film.png", {ViewLayout::kQuilt, {8, 6}, 1, 40}), "film_qs8x6a0.025.png");
}

TEST(ViewLayout, ADescriptionInTheNameIsNotRepeated) {
  EXPECT_EQ(Path("film_qs8x6a0.75.png", {ViewLayout::kQuilt, {8, 6}, 420, 560}),
            "film_qs8x6a0.75.png");
  EXPECT_EQ(Path("film_qs8x6a0.75.png", {ViewLayout::kQuilt, {8, 6}, 420, 560, 3}),
            "film_0003_qs8x6a0.75.png");
  EXPECT_EQ(Path("a_qs.png", {ViewLayout::kQuilt, {8, 6}, 420, 560}), "a_qs_qs8x6a0.75.png");
  EXPECT_EQ(Path("a_qs1z.png", {ViewLayout::kQuilt, {8, 6}, 420, 560}), "a_qs1z_qs8x6a0.75.png");
  const auto other = PathOfViews("film_qs5x9a0.75.png", {ViewLayout::kQuilt, {8, 6}, 420, 560});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::kUsage);
  EXPECT_NE(other.error().message.find("\"_qs8x6a0.75\""), std::string::npos);
}

TEST(ViewLayout, NamesOfOtherLayouts) {
  EXPECT_EQ(Path("film.mp4", {ViewLayout::kSideBySide, {}, 40, 30}), "film.mp4");
  EXPECT_EQ(Path("film.exr", {ViewLayout::kOverUnder, {}, 40, 30, 7}), "film_0007.exr");
  EXPECT_EQ(Path("film.exr", {ViewLayout::kLeftRight, {}, 40, 30, 7, 0}), "film_left_0007.exr");
  EXPECT_EQ(Path("film.mp4", {ViewLayout::kLeftRight, {}, 40, 30, {}, 1}), "film_right.mp4");
}

}  // namespace
}  // namespace lf
