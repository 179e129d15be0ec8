// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/plane_votes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lf {
namespace {

PinholeCamera VotingCamera(double x) {
  PinholeCamera camera;
  camera.intrinsics = {40, 40, 20, 15, 0, 40, 30, {}, {}};
  camera.cam_from_world.translation = Vec3(-x, 0, 0);
  return camera;
}

RenderCamera FrameOfVotes() {
  RenderCamera frame;
  frame.pinhole = VotingCamera(0);
  return frame;
}

// Returns the depths of a wall with the inverse depth 0.2 + number / 65534 * 0.8.
LfDepths Wall(uint16_t number, int divisor = 1) {
  LfDepths depths;
  depths.numbers = Image<uint16_t>(40 / divisor, 30 / divisor, 1, number);
  depths.least = 0.2;
  depths.greatest = 1;
  depths.divisor = divisor;
  return depths;
}

TEST(ProjectedDepths, MovesPixelsByTheirParallax) {
  // At an inverse depth of 0.6, 0.5 to the side are 12 elements.
  const Image<float> at = ProjectedDepths(Wall(32768), VotingCamera(0.5), FrameOfVotes());
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      if (x < 12)
        EXPECT_TRUE(std::isnan(at.at(x, y))) << x;
      else
        EXPECT_NEAR(at.at(x, y), 0.6, 1e-4) << x;
}

TEST(ProjectedDepths, PixelsOfPlanesThatAreReducedLeaveNoHoles) {
  const Image<float> at = ProjectedDepths(Wall(32768, 5), VotingCamera(0), FrameOfVotes());
  for (const float inverse : at.pixels()) EXPECT_NEAR(inverse, 0.6, 1e-4);
}

TEST(ProjectedDepths, TheNearestPointHidesOthersAndUnknownOnesAreLeftOut) {
  LfDepths depths = Wall(1);
  for (int y = 0; y < 30; ++y) depths.numbers.at(20, y) = 65535;
  for (int y = 0; y < 30; ++y) depths.numbers.at(30, y) = LfDepths::kUnknown;
  const Image<float> at = ProjectedDepths(depths, VotingCamera(0.125), FrameOfVotes());
  EXPECT_NEAR(at.at(25, 10), 1, 1e-4);    // 5 elements to the right
  EXPECT_NEAR(at.at(26, 10), 0.2, 1e-4);  // 1 element to the right
  EXPECT_TRUE(std::isnan(at.at(31, 10)));
}

TEST(Vote, ElectsTheDepthOfMostAndOfSeveralTheNearest) {
  ThreadPool pool(1);
  std::vector<Image<float>> candidates;
  for (const float inverse : {0.50f, 0.51f, 0.9f, 0.2f, 0.49f, 0.91f})
    candidates.emplace_back(2, 1, 1, inverse);
  candidates[0].at(1, 0) = std::nanf("");
  const VotedDepths voted = Vote(candidates, 0.025, pool);
  EXPECT_NEAR(voted.inverse.at(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(voted.confidence.at(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(voted.inverse.at(1, 0), 0.905, 1e-6);
  EXPECT_NEAR(voted.confidence.at(1, 0), 0.4, 1e-6);
  EXPECT_NEAR(voted.range.near_w, 1 / 0.905, 1e-6);
  EXPECT_NEAR(voted.range.far_w, 2, 1e-6);
  EXPECT_EQ(voted.view_count, 6u);
}

TEST(Vote, OneLfImageAloneIsNotBelieved) {
  ThreadPool pool(1);
  const std::vector<Image<float>> candidates = {Image<float>(1, 1, 1, 0.5f),
                                                Image<float>(1, 1, 1, 0.8f)};
  const VotedDepths voted = Vote(candidates, 0.1, pool);
  EXPECT_TRUE(std::isnan(voted.inverse.at(0, 0)));
  EXPECT_EQ(voted.confidence.at(0, 0), 0);
}

}  // namespace
}  // namespace lf
