// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/folded_poses.h"

#include <fmt/format.h>
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

TEST(ContradictingGroups, SmallGroupsCountIfFewLfImagesWereCompared) {
  const auto share = [](uint32_t i, uint32_t j) { return i % 2 == j % 2 ? 0.5 : 0.05; };
  EXPECT_EQ(ContradictingGroups(200, OnALine(14, share)).size(), 2u);
}

// Returns LF cameras at x = 0, 1, 2 ..., which look along z.
LightField LineOfCameras(uint32_t count) {
  LightField light_field;
  light_field.intrinsics.push_back({100, 100, 50, 50, 0, 100, 100, {}, {}});
  for (uint32_t i = 0; i < count; ++i) {
    LfCamera camera;
    camera.cam_from_world.translation = Vec3(-1.0 * i, 0, 0);
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(fmt::format("in/{}.jpg", i));
  }
  return light_field;
}

RenderCamera FrameAt(double x) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {100, 100, 50, 50, 0, 100, 100, {}, {}};
  frame.pinhole.cam_from_world.translation = Vec3(-x, 0, 0);
  frame.focus_distance_w = 100;
  return frame;
}

std::vector<std::vector<uint32_t>> EvenAndOdd(uint32_t count) {
  std::vector<std::vector<uint32_t>> groups(2);
  for (uint32_t i = 0; i < count; ++i) groups[i % 2].push_back(i);
  return groups;
}

TEST(GroupOfFilm, ALensAtACameraHasItsGroup) {
  for (const size_t number : {0u, 1u}) {
    const RenderCamera frames[] = {FrameAt(6.0 + static_cast<double>(number))};
    const auto found = GroupOfFilm(LineOfCameras(14), EvenAndOdd(14), frames);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->number, number);
    EXPECT_GT(found->share, 0.7);
    EXPECT_LT(found->share, 1);
  }
}

TEST(GroupOfFilm, NoneIsChosenBetweenGroupsOrIfTheFilmPassesFromOneToTheOther) {
  const LightField light_field = LineOfCameras(14);
  const auto groups = EvenAndOdd(14);
  const RenderCamera between[] = {FrameAt(6.5)};
  EXPECT_FALSE(GroupOfFilm(light_field, groups, between).has_value());
  const RenderCamera passing[] = {FrameAt(6), FrameAt(4), FrameAt(8), FrameAt(6), FrameAt(7)};
  EXPECT_FALSE(GroupOfFilm(light_field, groups, passing).has_value());
}

TEST(GroupOfFilm, LfImagesOfNoGroupCountAgainstAll) {
  auto groups = EvenAndOdd(14);
  groups[0].erase(groups[0].begin() + 3);  // camera 6
  const RenderCamera frames[] = {FrameAt(6)};
  EXPECT_FALSE(GroupOfFilm(LineOfCameras(14), groups, frames).has_value());
}

TEST(GroupOfFilm, WithoutLfCamerasThereIsNone) {
  const RenderCamera frames[] = {FrameAt(0)};
  EXPECT_FALSE(GroupOfFilm(LineOfCameras(0), EvenAndOdd(2), frames).has_value());
  EXPECT_FALSE(GroupOfFilm(LineOfCameras(1), EvenAndOdd(2), frames).has_value());
}

// Even and odd LF cameras contradict each other.
Result<std::vector<ComparedPair>> PairsOf(std::span<const uint32_t> ids) {
  std::vector<ComparedPair> pairs;
  for (size_t a = 0; a < ids.size(); ++a)
    for (size_t b = a + 1; b < std::min(a + 4, ids.size()); ++b)
      pairs.push_back(
          {ids[a], ids[b], 1.0 * ids[b] - ids[a], ids[a] % 2 == ids[b] % 2 ? 0.5 : 0.05});
  return pairs;
}

TEST(FindContradiction, AllLfImagesJoinTheGroupOfAFilm) {
  const LightField light_field = LineOfCameras(20);
  const std::vector<uint32_t> serving = {4, 5, 6, 7, 8, 9, 10, 11};
  const RenderCamera frames[] = {FrameAt(7)};
  const std::vector<std::string> source = {"in"};
  const auto found = FindContradiction(light_field, serving, frames, source, PairsOf);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kept, (std::vector<size_t>{1, 3, 5, 7, 9, 11, 13, 15, 17, 19}));
  EXPECT_GT(found->share, 0.7);
  for (const char* part :
       {"10 LF images are left out (0.jpg, 2.jpg, 4.jpg,", "made of the other 10 (1.jpg, 3.jpg,",
        "instead: lfimport in -o group_1 --exclude 1.jpg,3.jpg,5.jpg,"})
    EXPECT_NE(found->text.find(part), std::string::npos) << part << "\nis not in\n" << found->text;
}

TEST(FindContradiction, WithoutAFilmOrAClearGroupNoneIsKept) {
  const LightField light_field = LineOfCameras(20);
  const std::vector<uint32_t> serving = {4, 5, 6, 7, 8, 9, 10, 11};
  const RenderCamera between[] = {FrameAt(7.5)};
  const std::vector<std::string> source = {"in"};
  const std::vector<std::span<const RenderCamera>> films = {{}, between};
  for (const std::span<const RenderCamera> frames : films) {
    const auto found = FindContradiction(light_field, serving, frames, source, PairsOf);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->kept.empty());
    EXPECT_NE(found->text.find("contradict each other"), std::string::npos);
  }
}

TEST(FindContradiction, LfImagesThatAgreeAreNone) {
  const auto found = FindContradiction(LineOfCameras(20), std::vector<uint32_t>{0, 2, 4, 6, 8}, {},
                                       std::vector<std::string>{"in"}, PairsOf);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->text.empty());
  EXPECT_TRUE(found->kept.empty());
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
