// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/example_frame.h"

#include <gtest/gtest.h>

#include "lf/focus/moves/test_tracks.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

PinholeCamera Recorded(const Intrinsics& intrinsics) { return {intrinsics, RigidTransform()}; }

TEST(ExampleFrame, IsTheLfImageOfALevelCamera) {
  const Intrinsics frame = InscribedFrame(Recorded({90, 90, 50, 40, 0, 100, 80}), -Vec3::UnitY());
  EXPECT_EQ(frame, (Intrinsics{90, 90, 50, 40, 0, 100, 80}));
}

TEST(ExampleFrame, AnOffCentrePrincipalPointShiftsTheFrameInsteadOfCroppingIt) {
  const Intrinsics frame = InscribedFrame(Recorded({90, 90, 31, 44, 0, 100, 80}), -Vec3::UnitY());
  EXPECT_EQ(frame.width_px, 100);
  EXPECT_EQ(frame.height_px, 80);
  EXPECT_NEAR(frame.cx_px, 31, 1e-9);
  EXPECT_NEAR(frame.cy_px, 44, 1e-9);
}

TEST(ExampleFrame, APrincipalPointNearTheMiddleShiftsNothing) {
  const Intrinsics frame =
      InscribedFrame(Recorded({900, 900, 502, 400, 0, 1000, 800}), -Vec3::UnitY());
  EXPECT_EQ(frame.cx_px, frame.width_px / 2.0);
  EXPECT_GE(frame.width_px, 994);
}

TEST(ExampleFrame, IsAtMost1920Wide) {
  const Intrinsics frame =
      InscribedFrame(Recorded({4000, 4000, 2000, 1400, 0, 4200, 2800}), -Vec3::UnitY());
  EXPECT_EQ(frame.width_px, 1920);
  EXPECT_EQ(frame.height_px, 1280);
  EXPECT_NEAR(frame.fx_px, 4000 * 1920 / 4200.0, 1e-9);
  EXPECT_NEAR(frame.cx_px, 2000 * 1920 / 4200.0, 1e-9);
}

TEST(ExampleFrame, ACroppedFrameKeepsItsMiddle) {
  const Intrinsics frame = CroppedFrame({90, 90, 31, 44, 0, 100, 80}, 0.8);
  EXPECT_EQ(frame, (Intrinsics{90, 90, 21, 36, 0, 80, 64}));
}

TEST(Vertical, IsThatOfCamerasWhichLookDownFromOneSide) {
  // The mean of the up directions leans forwards.
  const LightField field = TrackOf(
      60,
      [](uint32_t i) {
        const double angle = RadiansFromDegrees(i - 30.0);
        return Vec3(std::sin(angle), -1, -std::cos(angle));
      },
      [](uint32_t) { return Vec3(Vec3::Zero()); });
  EXPECT_NEAR((VerticalWorld(field) - Vec3(0, -1, 0)).norm(), 0, 1e-9);
  EXPECT_GT((MeanUpWorld(field) - Vec3(0, -1, 0)).norm(), 0.3);
}

TEST(Vertical, OfParallelCamerasIsTheirMeanUpDirection) {
  const LightField field = NumberedGrid(5, false);
  EXPECT_EQ(VerticalWorld(field), MeanUpWorld(field));
}

}  // namespace
}  // namespace lf
