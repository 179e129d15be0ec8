// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/folded_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace lf {
namespace {

// Compares LF cameras 0, 1, 2 ... on a line with the three on either side.
std::vector<ComparedPair> OnALine(uint32_t count,
                                  const std::function<double(uint32_t, uint32_t)>& share) {
  std::vector<ComparedPair> pairs;
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t j = i + 1; j < std::min(i + 4, count); ++j)
      pairs.push_back({i, j, static_cast<double>(j - i), share(i, j)});
  return pairs;
}

TEST(ContradictingGroups, InterleavedCamerasOfTwoSidesAreFound) {
  const auto groups = ContradictingGroups(
      20, OnALine(20, [](uint32_t i, uint32_t j) { return i % 2 == j % 2 ? 0.5 : 0.05; }));
  ASSERT_EQ(groups.size(), 2u);
  for (const std::vector<uint32_t>& group : groups) {
    ASSERT_EQ(group.size(), 10u);
    for (const uint32_t i : group) EXPECT_EQ(i % 2, group[0] % 2);
  }
}

TEST(ContradictingGroups, CamerasThatAgreeLessFromFartherAwayAreOneGroup) {
  EXPECT_TRUE(
      ContradictingGroups(20, OnALine(20, [](uint32_t i, uint32_t j) { return 0.6 / (j - i); }))
          .empty());
}

TEST(ContradictingGroups, PartsThatStandBesideEachOtherDoNotContradict) {
  EXPECT_TRUE(
      ContradictingGroups(
          20, OnALine(20, [](uint32_t i, uint32_t j) { return i < 10 && j >= 10 ? 0 : 0.5; }))
          .empty());
}

TEST(ContradictingGroups, AFewBadImagesAreNoGroup) {
  const auto is_bad = [](uint32_t i) { return i == 6 || i == 8; };
  EXPECT_TRUE(ContradictingGroups(
                  30, OnALine(30, [&](uint32_t i,
                                      uint32_t j) { return is_bad(i) == is_bad(j) ? 0.5 : 0.02; }))
                  .empty());
}

TEST(ContradictingGroups, IfHardlyAnythingAgreesThereIsNoVerdict) {
  EXPECT_TRUE(
      ContradictingGroups(
          20, OnALine(20, [](uint32_t i, uint32_t j) { return i % 2 == j % 2 ? 0.1 : 0.01; }))
          .empty());
}

TEST(ContradictingGroups, WithoutPairsThereIsNone) {
  EXPECT_TRUE(ContradictingGroups(5, {}).empty());
}

TEST(ContradictionText, NamesRunsOfImagesAndTheOtherGroupsForEachCommand) {
  LightField light_field;
  for (const char* name : {"in/a.jpg", "in/b.jpg", "in/c.jpg", "in/d.jpg", "in/e.jpg", "in/f.jpg"})
    light_field.image_names.push_back(name);
  const std::vector<std::vector<uint32_t>> groups = {{0, 1, 2, 5}, {3, 4}};
  const std::vector<std::string> source = {"in put", "--focal-px", "70"};
  const std::string text = ContradictionText(light_field, groups, source);
  EXPECT_NE(text.find("group 1 has 4 (a.jpg to c.jpg, f.jpg)"), std::string::npos) << text;
  EXPECT_NE(text.find("lfimport 'in put' --focal-px 70 -o group_1 --exclude d.jpg,e.jpg"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("-o group_2 --exclude a.jpg,b.jpg,c.jpg,f.jpg"), std::string::npos) << text;
}

}  // namespace
}  // namespace lf
