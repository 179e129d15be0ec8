// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/film_blur.h"

#include <gtest/gtest.h>

#include "lf/densify/test_world.h"

namespace lf {
namespace {

// Returns a frame of 96 x 64 elements with a focal length of 100 elements, in focus at z = 2.
RenderCamera Frame(const FocusTilt& tilt = {}) {
  RenderCamera frame;
  frame.pinhole = CameraAt(0, 0);
  frame.aperture.radius_w = 0.05;
  frame.focus_distance_w = 2;
  frame.focus_tilt = tilt;
  frame.focus_plane = FocusPlane(frame.pinhole, 2, tilt);
  return frame;
}

// Returns points at a depth, spread over the picture.
std::vector<Vec3> Points(double depth, int count = 1000) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = (i % 40 - 20) / 50.0, y = (i / 40 % 25 - 12) / 50.0;
    points.push_back(depth * Vec3(x, y, 1));
  }
  return points;
}

std::vector<std::vector<Vec3>> EightTimes(const std::vector<Vec3>& points) {
  return std::vector<std::vector<Vec3>>(8, points);
}

TEST(CopiesPerDistance, IsTheShiftOfPointsAgainstTheFocus) {
  const RenderCamera frames[] = {Frame()};
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(Points(4))), 100 * (1.0 / 2 - 1.0 / 4), 1e-9);
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(Points(1))), 100 * (1.0 - 1.0 / 2), 1e-9);
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(Points(2))), 0, 1e-9);
}

TEST(CopiesPerDistance, CountsWhatTheFramesShow) {
  const RenderCamera frames[] = {Frame()};
  std::vector<Vec3> points = Points(4);
  for (Vec3 beside : Points(1)) points.push_back(beside + Vec3(3, 0, 0));
  for (Vec3 behind : Points(1)) points.push_back(-behind);
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(points)), 25, 1e-9);
  EXPECT_FALSE(CopiesPerDistance(frames, EightTimes(Points(4, 20))));
  EXPECT_FALSE(CopiesPerDistance(frames, {}));
}

TEST(CopiesPerDistance, IsThatOfTheFrameFarthestOutOfFocus) {
  std::vector<RenderCamera> frames(3, Frame());
  frames[2].focus_distance_w = 0.5;
  frames[2].focus_plane = FocusPlane(frames[2].pinhole, 0.5, {});
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(Points(4))), 100 * (2 - 0.25), 1e-9);
}

TEST(CopiesPerDistance, ATiltedPlaneIsInFocusAlongItself) {
  const RenderCamera frames[] = {Frame({0.4, -0.2})};
  std::vector<Vec3> points;
  for (int y = 2; y < 62; ++y)
    for (int x = 2; x < 94; ++x)
      points.push_back(*FocusPointOfElement(frames[0], x + 0.5, y + 0.5));
  EXPECT_NEAR(*CopiesPerDistance(frames, EightTimes(points)), 0, 1e-6);
}

TEST(CopiesPerDistance, FewPointsAndOneImageHardlyCount) {
  const RenderCamera frames[] = {Frame()};
  const auto with = [](int count) {
    std::vector<Vec3> points = Points(4);
    const std::vector<Vec3> near = Points(0.5, count);
    points.insert(points.end(), near.begin(), near.end());
    return EightTimes(points);
  };
  constexpr double kFar = 25, kNear = 100 * (2 - 0.5);
  EXPECT_NEAR(*CopiesPerDistance(frames, with(4)), kFar, 1e-9);
  EXPECT_NEAR(*CopiesPerDistance(frames, with(15)), kNear / 4, 1e-9);
  EXPECT_NEAR(*CopiesPerDistance(frames, with(60)), kNear, 1e-9);
  std::vector<std::vector<Vec3>> one = EightTimes(Points(4));
  one[3] = Points(0.5);
  EXPECT_NEAR(*CopiesPerDistance(frames, one), kFar, 1e-9);
  one[5] = one[3];
  EXPECT_NEAR(*CopiesPerDistance(frames, one), kNear / 4, 1e-9);
  one[0] = one[1] = one[2] = one[3];
  EXPECT_NEAR(*CopiesPerDistance(frames, one), kNear, 1e-9);
}

}  // namespace
}  // namespace lf
