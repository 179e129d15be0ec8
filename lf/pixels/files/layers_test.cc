// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/layers.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lf {
namespace {

using Names = std::vector<std::string>;

// Returns the names in their new order.
Names Ordered(const Names& names) {
  const Result<std::vector<int>> order = ColoursFirst(names, "a.exr");
  EXPECT_TRUE(order) << order.error().message;
  Names ordered;
  if (order)
    for (const int channel : *order) ordered.push_back(names[channel]);
  return ordered;
}

TEST(Layers, PlainColoursComeFirst) {
  EXPECT_EQ(Ordered({"A", "B", "G", "R", "Z"}), (Names{"R", "G", "B", "A", "Z"}));
  EXPECT_EQ(Ordered({"N.B", "N.G", "N.R", "B", "G", "R"}),
            (Names{"R", "G", "B", "N.B", "N.G", "N.R"}));
  EXPECT_EQ(Ordered({"count.R", "G"}), (Names{"G", "count.R"}));
}

TEST(Layers, TheColoursOfTheOnlyLayerThatHasThem) {
  EXPECT_EQ(Ordered({"Z", "beauty.main.A", "beauty.main.B", "beauty.main.G", "beauty.main.R"}),
            (Names{"beauty.main.R", "beauty.main.G", "beauty.main.B", "beauty.main.A", "Z"}));
  EXPECT_EQ(Ordered({"N.X", "N.Y", "d.B", "d.G", "d.R"}),
            (Names{"d.R", "d.G", "d.B", "N.X", "N.Y"}));
}

TEST(Layers, OthersStayAsTheyAre) {
  EXPECT_EQ(Ordered({"Y"}), Names{"Y"});
  EXPECT_EQ(Ordered({"X", "Y", "Z"}), (Names{"X", "Y", "Z"}));
}

TEST(Layers, ColoursInSeveralLayersAreAnError) {
  const auto order = ColoursFirst({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}, "a.exr");
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().message.find("a.exr: has colours in the layers a and b"), 0u);
}

}  // namespace
}  // namespace lf
