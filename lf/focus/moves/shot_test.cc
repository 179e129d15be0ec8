// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/shot.h"

#include <gtest/gtest.h>

#include "lf/focus/moves/test_tracks.h"

namespace lf {
namespace {

TEST(StandInARow, IsTrueForATrackButNotForAGrid) {
  const LightField track = HandHeld(41, 0.001);
  EXPECT_TRUE(StandInARow(track, track.Camera({20}), 0.03));
  const LightField grid = NumberedGrid(9, false);
  EXPECT_FALSE(StandInARow(grid, grid.Camera({40}), 2.1));
  const LightField slanted = TrackOf(
      9, [](uint32_t i) { return Vec3(i, i, 0); }, [](uint32_t i) { return Vec3(i, i, 9); });
  EXPECT_TRUE(StandInARow(slanted, slanted.Camera({4}), 3));
}

TEST(StandInARow, OneOrTwoCamerasAreNoRow) {
  const LightField track = HandHeld(41, 0);
  EXPECT_FALSE(StandInARow(track, track.Camera({20}), 0.001));
  EXPECT_FALSE(StandInARow(track, track.Camera({0}), 0.01));
}

}  // namespace
}  // namespace lf
