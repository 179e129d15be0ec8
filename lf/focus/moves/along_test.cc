// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/along.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lf/focus/moves/test_tracks.h"

namespace lf {
namespace {

// Returns a shot with a lens that is four spacings of LF cameras wide.
Shot ShotAt(const LightField& field, LfImageId id, double focus_distance_w) {
  return ShotAt(field, id, focus_distance_w, 2 * MedianSpacing(field));
}

CameraMove Along(const LightField& field, LfImageId id, const Shot& shot) {
  return MakeAlong(field, *FindTrack(field, id), shot);
}

TEST(Along, ACalmPartOfALongTrackIsTwelveDegreesInFourSeconds) {
  const LightField field = HandHeld(200, 0.002);
  const CameraMove move = Along(field, {100}, ShotAt(field, {100}, 1));
  EXPECT_NEAR(DegreesFromRadians(LengthOf(move)), 12, 0.6);
  EXPECT_NEAR(move.duration_s, 4, 0.2);
  EXPECT_NE(move.limit.find("a calm film goes no farther"), std::string::npos) << move.limit;
  for (const Vec3& key : move.keys_world) {
    EXPECT_NEAR(key.norm(), 1, 0.002);
    EXPECT_NEAR(key.y(), 0, 0.002);
  }
  // The speed is even, and the order that of the recording.
  for (size_t i = 1; i < move.keys_world.size(); ++i) {
    const Vec3 step = move.keys_world[i] - move.keys_world[i - 1];
    EXPECT_NEAR(step.norm(), LengthOf(move) / 8, 0.05 * LengthOf(move) / 8);
    EXPECT_GT(step.x(), 0);
  }
}

TEST(Along, TheLensStaysWithinTheTrack) {
  const LightField field = HandHeld(16, 0);
  const Shot shot = ShotAt(field, {3}, 1);
  const CameraMove move = Along(field, {3}, shot);
  const double track_w = RadiansFromDegrees(0.5) * 15;
  EXPECT_NEAR(LengthOf(move), track_w - 2 * shot.lens_radius_w, 0.01);
  EXPECT_LT(LengthOf(move), track_w - 2 * shot.lens_radius_w + 1e-6);
  EXPECT_NE(move.limit.find("past the end of the track"), std::string::npos) << move.limit;
}

TEST(Along, EndsWhereTheCamerasLookElsewhere) {
  // From image 110 on, the hand turns away from the subject.
  const LightField field = TrackOf(
      200, [](uint32_t i) { return Vec3(0.01 * i, 0, -1); },
      [](uint32_t i) { return Vec3(i < 110 ? 1 : 1 + 0.2 * (i - 109), 0, 0); });
  const CameraMove move = Along(field, {100}, ShotAt(field, {100}, 1));
  const auto to_the_right =
      std::max_element(move.keys_world.begin(), move.keys_world.end(),
                       [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
  EXPECT_LT(to_the_right->x(), 1.15);
  EXPECT_GT(LengthOf(move), 0.05);
}

TEST(Along, EndsWhereTheTrackTurns) {
  const LightField field = TrackOf(
      200,
      [](uint32_t i) { return i < 110 ? Vec3(0.01 * i, 0, 0) : Vec3(1.1, 0.01 * (i - 110), 0); },
      [](uint32_t) { return Vec3(1, 0, 9); });
  const CameraMove move = Along(field, {100}, ShotAt(field, {100}, 9.0));
  for (const Vec3& key : move.keys_world) EXPECT_LT(key.y(), 0.3);
  EXPECT_NE(move.limit.find("the track turns"), std::string::npos) << move.limit;
}

TEST(Along, ATrackNarrowerThanTheLensHasNoRoom) {
  const LightField field = HandHeld(4, 0);
  EXPECT_EQ(LengthOf(Along(field, {2}, ShotAt(field, {2}, 1))), 0);
}

}  // namespace
}  // namespace lf
