// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/recorded_track.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/focus/moves/test_tracks.h"

namespace lf {
namespace {

TEST(RecordedTrack, NamesThatDifferInTheirLastNumberAreASequence) {
  LightField field = HandHeld(40, 0);
  std::swap(field.cameras[3], field.cameras[30]);
  std::swap(field.image_names[3], field.image_names[30]);
  field.image_names[7] = "images/other_7.png";
  const RecordedTrack track = *FindTrack(field, {20});
  ASSERT_EQ(track.images.size(), 39u);
  EXPECT_EQ(track.images[3], LfImageId{30});
  EXPECT_EQ(track.images[track.at], LfImageId{20});
  EXPECT_NEAR(track.neighbour_w, RadiansFromDegrees(0.5), 1e-6);
}

TEST(RecordedTrack, TheOrderIsThatOfTheNumbersNotOfTheirDigits) {
  LightField field = HandHeld(40, 0);
  for (uint32_t i = 0; i < 40; ++i) field.image_names[i] = "IMG_" + std::to_string(i) + "_left.jpg";
  const RecordedTrack track = *FindTrack(field, {0});
  for (uint32_t i = 0; i < 40; ++i) EXPECT_EQ(track.images[i], LfImageId{i});
}

TEST(RecordedTrack, EndsWhereTheCameraJumps) {
  const LightField grid = NumberedGrid(5, false);
  const RecordedTrack row = *FindTrack(grid, {12});
  ASSERT_EQ(row.images.size(), 5u);
  EXPECT_EQ(row.images.front(), LfImageId{10});
  EXPECT_EQ(row.at, 2u);
  EXPECT_EQ(row.places_w.back(), 4);
}

TEST(RecordedTrack, MissingImagesAreNoJump) {
  LightField field = HandHeld(40, 0);
  field.cameras.erase(field.cameras.begin() + 10, field.cameras.begin() + 13);
  field.image_names.erase(field.image_names.begin() + 10, field.image_names.begin() + 13);
  EXPECT_EQ(FindTrack(field, {20})->images.size(), 37u);
}

TEST(RecordedTrack, NamesInAnyOrderAreNone) {
  const LightField field = TrackOf(
      100,
      [](uint32_t i) {
        const uint32_t place = i * 37 % 100;
        return Vec3(place % 10, place / 10, 0);
      },
      [](uint32_t) { return Vec3(5, 5, 100); });
  const Result<RecordedTrack> track = FindTrack(field, {50});
  ASSERT_FALSE(track);
  EXPECT_NE(track.error().message.find("are 6.71 apart"), std::string::npos)
      << track.error().message;
}

TEST(RecordedTrack, NamesWithoutNumbersAreNone) {
  LightField field = HandHeld(40, 0);
  for (std::string& name : field.image_names) name = "image.png";
  EXPECT_FALSE(FindTrack(field, {20}));
}

TEST(RecordedTrack, ACameraAtRestIsOnePlace) {
  const auto position = [](uint32_t i) { return Vec3(std::max(i, 4u), 0, 0); };
  const LightField field =
      TrackOf(30, position, [&](uint32_t i) { return Vec3(position(i) + Vec3(0, 0, 5)); });
  const RecordedTrack track = *FindTrack(field, {3});
  EXPECT_EQ(track.images.size(), 26u);
  EXPECT_EQ(track.images[track.at], LfImageId{3});
}

TEST(DenseTrack, IsAVideoHeldByHandButNoGrid) {
  for (const double shake_w : {0.0, 0.002, 0.005}) {
    const LightField video = HandHeld(200, shake_w);
    EXPECT_TRUE(IsDenseTrack(video, *FindTrack(video, {100}), 1)) << shake_w;
  }
  for (const bool is_serpentine : {false, true})
    for (const uint32_t side : {3u, 5u, 9u, 17u}) {
      const LightField grid = NumberedGrid(side, is_serpentine);
      const LfImageId middle{side * side / 2};
      EXPECT_FALSE(IsDenseTrack(grid, *FindTrack(grid, middle), 100)) << side << is_serpentine;
    }
}

TEST(DenseTrack, NeighboursAreNear) {
  const LightField video = HandHeld(200, 0);
  const RecordedTrack track = *FindTrack(video, {100});
  EXPECT_FALSE(IsDenseTrack(video, track, 0.1));  // five degrees as seen from the subject
  const LightField few = HandHeld(10, 0);
  EXPECT_FALSE(IsDenseTrack(few, *FindTrack(few, {5}), 1));
}

TEST(SmoothTrack, LeavesALineAsItIsUpToItsEnds) {
  const LightField field = TrackOf(
      20, [](uint32_t i) { return Vec3(2, 0.1 * i, 0); },
      [](uint32_t i) { return Vec3(2, 0.1 * i, 5); });
  const RecordedTrack track = *FindTrack(field, {10});
  const SmoothTrack smooth(track, 0.3);
  for (const double place_w : {0.0, 0.05, 1.0, 1.9}) {
    EXPECT_NEAR((smooth.At(place_w).position_world - Vec3(2, place_w, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR((smooth.At(place_w).direction_world - Vec3(0, 1, 0)).norm(), 0, 1e-9);
  }
}

TEST(SmoothTrack, RemovesTheShakingOfTheHand) {
  const LightField field = HandHeld(200, 0.003);
  const RecordedTrack track = *FindTrack(field, {100});
  const SmoothTrack smooth(track, 0.05);
  for (size_t i = 20; i < 180; ++i) {
    const Vec3 point = smooth.At(track.places_w[i]).position_world;
    EXPECT_NEAR(point.norm(), 1, 0.002);
    EXPECT_NEAR(point.y(), 0, 0.002);
  }
}

}  // namespace
}  // namespace lf
