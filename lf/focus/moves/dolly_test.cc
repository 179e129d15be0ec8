// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/dolly.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/focus/moves/test_tracks.h"

namespace lf {
namespace {

TEST(Dolly, TheLensStaysWithinAGrid) {
  const LightField field = NumberedGrid(9, false);
  const CameraMove move = MakeDolly(field, ShotAt(field, {40}, 100, 2));
  // The border of the picture passes the positions 4 - 2 beside the middle of the lens, at most.
  EXPECT_LE(LengthOf(move), 2 * 2 * 2 * 100 / 100 + 1e-6);
  EXPECT_GT(LengthOf(move), 4);
}

TEST(Dolly, ARowOfCamerasMovesWithinTheLens) {
  const LightField field = TrackOf(
      61, [](uint32_t i) { return Vec3(0.01 * (i - 30.0), 0, 0); },
      [](uint32_t i) { return Vec3(0.01 * (i - 30.0), 0, 1); });
  const Shot shot = ShotAt(field, {30}, 1, 0.05);
  const CameraMove move = MakeDolly(field, shot);
  // At the upper border, the row passes the lens at up to half of its radius.
  const double most_w = 0.025 * 2 * 100 / 80;
  EXPECT_GT(LengthOf(move), 0.9 * most_w) << move.limit;
  for (const Vec3& key : move.keys_world) {
    EXPECT_LE(key.norm(), most_w + 1e-6);
    EXPECT_NEAR(key.x(), 0, 1e-9);
    EXPECT_NEAR(key.y(), 0, 1e-9);
  }
}

TEST(Dolly, ARowOfCamerasHasNoRoomForAPinhole) {
  const LightField field = TrackOf(
      61, [](uint32_t i) { return Vec3(0.01 * (i - 30.0), 0, 0); },
      [](uint32_t i) { return Vec3(0.01 * (i - 30.0), 0, 1); });
  const CameraMove move = MakeDolly(field, ShotAt(field, {30}, 1, 0));
  EXPECT_EQ(LengthOf(move), 0);
  EXPECT_NE(move.limit.find("through too few LF cameras"), std::string::npos) << move.limit;
}

}  // namespace
}  // namespace lf
