// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/orbit.h"

#include <gtest/gtest.h>

#include <string>

#include "lf/focus/moves/test_tracks.h"

namespace lf {
namespace {

TEST(Orbit, ADenseGridAllowsAllThatIsCalm) {
  // 61 x 61 LF cameras, of which the nearest 400 fill a circle of radius 11.
  const LightField field = NumberedGrid(61, false);
  const LfImageId middle{30 * 61 + 30};
  const double focus_w = 300, calm_w = RadiansFromDegrees(8) * focus_w;
  Shot shot = ShotAt(field, middle, focus_w, 4);
  shot.reach = ReachNear(field, shot.start, RadiansFromDegrees(6) * focus_w + 9);
  const CameraMove move = MakeOrbit(field, shot);
  EXPECT_NE(move.limit.find("a calm film goes no farther"), std::string::npos) << move.limit;
  EXPECT_EQ(move.warning, "");
  EXPECT_NEAR((move.keys_world[0] - move.keys_world[4]).norm(), calm_w, 1e-6);
  EXPECT_NEAR((move.keys_world[2] - move.keys_world[6]).norm(), calm_w, 1e-6);
}

TEST(Orbit, IsNoWiderThanTheLensHasRoomFor) {
  const LightField field = NumberedGrid(9, false);
  const CameraMove move = MakeOrbit(field, ShotAt(field, {40}, 100, 2));
  for (const Vec3& key : move.keys_world) {
    EXPECT_LE((key - Vec3(4, 4, 0)).cwiseAbs().maxCoeff(), 2 + 1e-9);
  }
}

TEST(Orbit, FramesAreCroppedToWhatIsRecorded) {
  const LightField field = NumberedGrid(15, false);
  const CameraMove move = MakeOrbit(field, ShotAt(field, {112}, 60, 1));
  EXPECT_LT(move.crop, 1);
  EXPECT_NE(move.limit.find("LF cameras have not recorded wider ones"), std::string::npos)
      << move.limit;
}

}  // namespace
}  // namespace lf
