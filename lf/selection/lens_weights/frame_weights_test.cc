// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/frame_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/core/random.h"
#include "lf/selection/lens_weights/lens_cells.h"

namespace lf {
namespace {

ThreadPool& Pool() {
  static ThreadPool pool(2);
  return pool;
}

// Returns a camera at (0, 0, z) that looks along the z axis and is focused on the plane z = 2.
RenderCamera Frame(double radius_w, double z = 0) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {1200, 1200, 640, 400, 0, 1280, 800, {}};
  frame.pinhole.cam_from_world = *LookAlong({0, 0, z}, Vec3::UnitZ(), -Vec3::UnitY());
  frame.aperture.radius_w = radius_w;
  frame.focus_plane = {Vec3::UnitZ(), 2};
  return frame;
}

std::vector<Vec3> JitteredGrid(int side, double spacing, double jitter, uint64_t seed) {
  RandomSequence random(seed);
  std::vector<Vec3> centres;
  for (int y = -side; y <= side; ++y)
    for (int x = -side; x <= side; ++x) {
      const double dx = random.Uniform(-jitter, jitter), dy = random.Uniform(-jitter, jitter);
      centres.emplace_back(spacing * (x + dx), spacing * (y + dy), 0);
    }
  return centres;
}

// Returns the shares of all cameras at a position of the plate, computed without interpolation.
std::vector<double> ExactShares(const RenderCamera& frame, const std::vector<Vec3>& centres,
                                double x, double y) {
  const Vec3 focus = *FocusPointOfElement(frame, x, y);
  std::vector<Vec2> points;
  for (const Vec3& centre : centres) points.push_back(LensPointOfLine(frame, centre, focus));
  return CellShares(points, frame.aperture);
}

// Returns the weights at an element, divided by their sum.
std::vector<double> SharesOf(const FrameWeights& weights, size_t camera_count, int x, int y) {
  std::vector<double> shares;
  double sum = 0;
  for (size_t i = 0; i < camera_count; ++i) {
    shares.push_back(weights.At(i, x, y));
    sum += shares.back();
  }
  for (double& share : shares) share /= sum;
  return shares;
}

TEST(FrameWeights, OfVeryManyLfImagesFitThePlate) {
  for (const int side : {20, 100}) {
    const std::vector<Vec3> centres = JitteredGrid(side, 0.02, 0.3, 1);
    const FrameWeights weights(Frame(0.018 * side), centres, LensWeights::kArea, Pool());
    double together = 0;
    uint32_t most = 0;
    for (size_t i = 0; i < centres.size(); ++i) {
      most = std::max(most, weights.At(i, 600, 400));
      together += weights.At(i, 600, 400);
    }
    EXPECT_LE(together, 1.01 * FrameWeights::kMostTogether);
    EXPECT_EQ(most == kMaxWeight, side == 20) << most;
    EXPECT_GT(most, 50u);
  }
}

// Each position occurs three times, as in brackets.
TEST(FrameWeights, BracketsShareThePlaceAndNothingElse) {
  const std::vector<Vec3> places = JitteredGrid(4, 0.02, 0.3, 3);
  std::vector<Vec3> centres;
  for (const Vec3& place : places) centres.insert(centres.end(), 3, place);
  for (const auto& [radius_w, kind] :
       {std::pair(0.06, LensWeights::kArea), std::pair(0.008, LensWeights::kHat),
        std::pair(0.012, LensWeights::kAuto)}) {
    const FrameWeights alone(Frame(radius_w), places, kind, Pool());
    const FrameWeights three(Frame(radius_w), centres, kind, Pool(), true);
    EXPECT_DOUBLE_EQ(three.hat_share(), alone.hat_share());
    const std::vector<double> of_alone = SharesOf(alone, places.size(), 600, 400);
    const std::vector<double> of_three = SharesOf(three, centres.size(), 600, 400);
    for (size_t i = 0; i < centres.size(); ++i)
      EXPECT_NEAR(of_three[i], of_alone[i / 3] / 3, 0.002);
  }
}

TEST(FrameWeights, DistinctPlacesHaveEachOnce) {
  const std::vector<Vec3> centres = {{1, 2, 3}, {0, 2, 3}, {1, 2, 3}, {1, 2, 2}, {0, 2, 3}};
  EXPECT_EQ(DistinctPlaces(centres), (std::vector<Vec3>{{0, 2, 3}, {1, 2, 2}, {1, 2, 3}}));
  EXPECT_TRUE(DistinctPlaces({}).empty());
}

TEST(LensPoints, AreWhereLinesMeetTheLens) {
  RandomSequence random(1);
  const auto any = [&] {
    const double x = random.Uniform(-1, 1), y = random.Uniform(-1, 1);
    return Vec3(x, y, random.Uniform(-1, 1));
  };
  for (int i = 0; i < 200; ++i) {
    RenderCamera frame;
    frame.pinhole.cam_from_world = *LookAlong(any(), any(), Vec3::UnitY());
    const Vec2 point(random.Uniform(-1, 1), random.Uniform(-1, 1));
    const Vec3 on_lens = LensPointWorld(frame, point);
    const Vec3 seen = any();
    const Vec3 centre = seen + random.Uniform(0.5, 2) * (on_lens - seen);
    EXPECT_NEAR((LensPointOfLine(frame, centre, seen) - point).norm(), 0, 1e-9);
  }
}

TEST(FrameWeights, OfCamerasInTheLensPlaneAreConstantAndTheirCells) {
  const RenderCamera frame = Frame(0.05);
  const auto centres = JitteredGrid(10, 0.01, 0.4, 2);
  const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
  EXPECT_TRUE(weights.ConstantOf(0).has_value());
  const auto exact = ExactShares(frame, centres, 640, 400);
  const double most = *std::max_element(exact.begin(), exact.end());
  for (size_t i = 0; i < centres.size(); ++i) {
    EXPECT_EQ(weights.At(i, 0, 0), weights.At(i, 1279, 799));
    EXPECT_NEAR(weights.At(i, 5, 7), 255 * exact[i] / most, 0.51);
    EXPECT_EQ(weights.TakesPart(i), exact[i] > 1e-9);
    if (weights.TakesPart(i)) {
      EXPECT_LE(centres[i].norm(), weights.reach_w() + 1e-12);
    }
  }
}

TEST(FrameWeights, OfAnEvenGridAreTheLargestThereIs) {
  const auto centres = JitteredGrid(10, 0.01, 0, 0);
  const FrameWeights weights(Frame(0.05), centres, LensWeights::kArea, Pool());
  for (size_t i = 0; i < centres.size(); ++i)
    if (centres[i].norm() < 0.04) {
      EXPECT_EQ(weights.At(i, 9, 9), kMaxWeight);
    }
}

TEST(FrameWeights, BesideTheLensPlaneAreInterpolatedBetweenNodes) {
  for (const double z : {-0.3, -0.05, 0.02, 0.4}) {
    const RenderCamera frame = Frame(0.06, z);
    const auto centres = JitteredGrid(30, 0.015, 0.3, 3);
    const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
    EXPECT_GT(weights.columns() * weights.rows(), 1);
    EXPECT_LE(weights.columns(), 48);
    double squares = 0, error_squares = 0;
    for (int y = 20; y < 800; y += 130)
      for (int x = 20; x < 1280; x += 130) {
        const auto exact = ExactShares(frame, centres, x + 0.5, y + 0.5);
        const auto found = SharesOf(weights, centres.size(), x, y);
        for (size_t i = 0; i < centres.size(); ++i) {
          squares += exact[i] * exact[i];
          error_squares += (found[i] - exact[i]) * (found[i] - exact[i]);
        }
      }
    EXPECT_LT(std::sqrt(error_squares / squares), 0.1) << z;
  }
}

// For the camera in the middle of an even grid, the elements with a weight are around the middle of
// the plate.
TEST(FrameWeights, BesideTheLensPlaneLieWhereTheCameraIsSeen) {
  const RenderCamera frame = Frame(0.06, 0.4);
  const auto centres = JitteredGrid(30, 0.015, 0, 3);
  const size_t middle = centres.size() / 2;
  EXPECT_EQ(centres[middle].norm(), 0);
  const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
  double sum = 0;
  Vec2 place = Vec2::Zero();
  for (int y = 0; y < 800; ++y)
    for (int x = 0; x < 1280; ++x) {
      const double weight = weights.At(middle, x, y);
      sum += weight;
      place += weight * Vec2(x + 0.5, y + 0.5);
    }
  EXPECT_GT(sum, 0);
  EXPECT_EQ(weights.At(middle, 10, 400), 0u);  // only some elements see this camera
  EXPECT_NEAR(place.x() / sum, 640, 1);
  EXPECT_NEAR(place.y() / sum, 400, 1);
}

// More shares than kMostShares: whole cells on a coarse grid. A mean over the lens of something
// that differs from one half to the other is the same as with exact shares.
TEST(FrameWeights, OfVeryManyCamerasAreWholeCells) {
  RenderCamera frame = Frame(0.5, 0.1);
  std::vector<Vec3> centres = JitteredGrid(60, 0.01, 0.4, 8);
  RandomSequence random(1);
  std::erase_if(centres, [&](const Vec3& centre) {  // three quarters are missing on the right
    return centre.x() > 0.05 && random.Uniform(0, 1) > 0.25;
  });
  frame.aperture.blades = 5;
  const FrameWeights weights(frame, centres, LensWeights::kAuto, Pool());
  ASSERT_TRUE(weights.keeps_opening());
  EXPECT_GT(weights.columns() * weights.rows(), 1);
  EXPECT_LE(weights.columns() * weights.rows() * centres.size(), FrameWeights::kWholeCellShares);
  EXPECT_EQ(weights.reach_w(), frame.aperture.radius_w);
  const ApertureTest opening(frame.aperture);
  for (const auto& [x, y] : {std::pair(640, 400), std::pair(40, 700), std::pair(1270, 3)}) {
    const std::vector<double> exact = ExactShares(frame, centres, x + 0.5, y + 0.5);
    const Vec3 focus = *FocusPointOfElement(frame, x + 0.5, y + 0.5);
    double sum = 0, exact_sum = 0;
    Vec2 right_and_above = Vec2::Zero(), exactly = Vec2::Zero();
    for (size_t i = 0; i < centres.size(); ++i) {
      const Vec2 through = LensPointOfLine(frame, centres[i], focus);
      const Vec2 side(through.x() > 0.1 ? 1 : 0, through.y() > -0.2 ? 1 : 0);
      const double weight = opening.Contains(through) ? weights.At(i, x, y) : 0;
      sum += weight;
      right_and_above += weight * side;
      exact_sum += exact[i];
      exactly += exact[i] * side;
    }
    EXPECT_LE(sum, FrameWeights::kMostTogether);
    EXPECT_NEAR(right_and_above.x() / sum, exactly.x() / exact_sum, 0.005) << x << " " << y;
    EXPECT_NEAR(right_and_above.y() / sum, exactly.y() / exact_sum, 0.005) << x << " " << y;
  }
}

TEST(FrameWeights, FewerCamerasKeepTheirCells) {
  const std::vector<Vec3> centres = JitteredGrid(20, 0.01, 0.4, 8);
  EXPECT_FALSE(FrameWeights(Frame(0.5), centres, LensWeights::kAuto, Pool()).keeps_opening());
  EXPECT_FALSE(FrameWeights(Frame(0.1, 0.1), centres, LensWeights::kAuto, Pool()).keeps_opening());
}

TEST(FrameWeights, RaysBeyondTheirReachHaveNone) {
  const RenderCamera frame = Frame(0.06, 0.1);
  const auto centres = JitteredGrid(30, 0.015, 0.3, 4);
  const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
  for (int y = 0; y < 800; y += 40)
    for (int x = 0; x < 1280; x += 40) {
      const Vec3 focus = *FocusPointOfElement(frame, x + 4, y + 4);
      for (size_t i = 0; i < centres.size(); ++i)
        if (weights.At(i, x, y) > 0) {
          ASSERT_LE(LensPointOfLine(frame, centres[i], focus).norm(), weights.reach_w());
        }
    }
}

TEST(FrameWeights, AreTheSameInBlocksOfEachCamerasOwn) {
  const auto centres = JitteredGrid(10, 0.02, 0.3, 5);
  const FrameWeights weights(Frame(0.06, 0.2), centres, LensWeights::kArea, Pool());
  size_t shifted = 0;
  for (size_t i = 0; i < centres.size(); i += 7) {
    const WeightBlocks blocks = weights.BlocksOf(i);
    shifted += blocks.shift_x != 0 && blocks.shift_y != 0 ? 1 : 0;
    for (int y = 0; y < 800; y += 13)
      for (int x = 0; x < 1280; x += 15)
        ASSERT_EQ(weights.At(i, x, y), weights.At(i, std::min(1279, blocks.EndX(x) - 1),
                                                  std::min(799, blocks.EndY(y) - 1)));
  }
  EXPECT_GT(shifted, 20u);
}

// Compares OfRow(), which goes from node to node, with At(), for grids of different numbers of
// columns and rows of nodes.
TEST(FrameWeights, RowsOfBlocksHaveTheWeightsOfTheirElements) {
  size_t different = 0;
  for (const auto& [z, tilt] : {std::pair(0.0, 0.0), {0.004, 0.0}, {0.02, 0.1}, {0.1, 0.3}}) {
    RenderCamera frame = Frame(0.06, z);
    // A plate whose sides are no multiples of a block.
    frame.pinhole.intrinsics.width_px = 1283;
    frame.pinhole.intrinsics.height_px = 797;
    frame.focus_plane.normal = Vec3(tilt, 0, 1).normalized();
    const auto centres = JitteredGrid(9, 0.015, 0.3, 6);
    const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
    for (size_t camera = 0; camera < centres.size(); camera += 3) {
      const WeightBlocks blocks = weights.BlocksOf(camera);
      for (int y = static_cast<int>(camera % 7); y < 797; y += 53)
        for (const int x : {0, 5, 641, 1280}) {
          const int count = (1283 - 1 - (blocks.EndX(x) - kWeightBlock)) / kWeightBlock + 1;
          std::vector<uint8_t> row(static_cast<size_t>(count));
          weights.OfRow(camera, blocks.EndX(x), blocks.EndY(y), count, row.data());
          for (int i = 0; i < count; ++i) {
            const int at = std::min(1282, x + i * kWeightBlock);
            ASSERT_EQ(row[static_cast<size_t>(i)], weights.At(camera, at, y))
                << z << ", " << camera << ", " << at << ", " << y;
            different += row[static_cast<size_t>(i)] != row[0];
          }
        }
    }
  }
  EXPECT_GT(different, 10000u);
}

TEST(FrameWeights, OneCameraWithAHugeShareLeavesTheOthersTheirs) {
  // Cameras around the lens centre, which are then moved into a corner of the lens.
  std::vector<Vec3> centres = JitteredGrid(10, 0.002, 0.3, 6);
  for (Vec3& c : centres) c += Vec3(0.1, 0.1, 0);
  centres.emplace_back(-0.1, -0.1, 0);
  const FrameWeights weights(Frame(0.2), centres, LensWeights::kArea, Pool());
  EXPECT_EQ(weights.At(centres.size() - 1, 0, 0), kMaxWeight);
  // The last camera represents about half of the lens, the cameras in the corner the other half.
  double others = 0;
  for (size_t i = 0; i + 1 < centres.size(); ++i) others += weights.At(i, 0, 0);
  EXPECT_NEAR(others / (others + kMaxWeight), 0.5, 0.15);
}

TEST(FrameWeights, ManyCamerasAtOnePlaceLeaveTheOthersTheirs) {
  std::vector<Vec3> centres = JitteredGrid(5, 0.01, 0.3, 9);
  const size_t count = centres.size();
  const FrameWeights alone(Frame(0.04), centres, LensWeights::kArea, Pool());
  for (int i = 0; i < 300; ++i) centres.push_back(centres[count / 2] + Vec3(1e-7 * i, 0, 0));
  const FrameWeights weights(Frame(0.04), centres, LensWeights::kArea, Pool());
  const auto relative = [&](const FrameWeights& of, size_t i) {
    uint32_t most = 0;
    for (size_t k = 0; k < count; ++k)
      if (k != count / 2) most = std::max(most, of.At(k, 0, 0));
    return static_cast<double>(of.At(i, 0, 0)) / most;
  };
  for (size_t i = 0; i < count; ++i) {
    if (i != count / 2) {
      EXPECT_NEAR(relative(weights, i), relative(alone, i), 0.02) << i;
    }
  }
}

// Even a tiny share of hats gives weights to many more cameras. They must not change the weights of
// the others.
TEST(FrameWeights, AutoIsSteadyWhereTheLastHatsGo) {
  constexpr double kSpacing = 0.01;
  const auto centres = JitteredGrid(6, kSpacing, 0.3, 10);
  const auto shares = [&](double distances) {
    return SharesOf(
        FrameWeights(Frame(0.5 * distances * kSpacing), centres, LensWeights::kAuto, Pool()),
        centres.size(), 0, 0);
  };
  std::vector<double> last = shares(1.2);
  for (double distances = 1.21; distances < 2.5; distances += 0.01) {
    const std::vector<double> now = shares(distances);
    double difference = 0;
    for (size_t i = 0; i < now.size(); ++i) difference += std::abs(now[i] - last[i]);
    EXPECT_LT(difference, 0.06) << distances;
    last = now;
  }
}

TEST(FrameWeights, HatsOfAPinholeGoToTheCamerasAroundIt) {
  RenderCamera frame = Frame(0);
  frame.pinhole.cam_from_world = *LookAlong({0.0005, 0.0005, 0}, Vec3::UnitZ(), -Vec3::UnitY());
  const auto centres = JitteredGrid(5, 0.001, 0, 0);
  const FrameWeights weights(frame, centres, LensWeights::kHat, Pool());
  size_t taking_part = 0;
  for (size_t i = 0; i < centres.size(); ++i) {
    taking_part += weights.TakesPart(i) ? 1 : 0;
    if (weights.TakesPart(i)) {
      EXPECT_EQ(weights.At(i, 40, 40), kMaxWeight);
    }
  }
  EXPECT_EQ(taking_part, 4u);
}

TEST(FrameWeights, AutoGoesFromHatsToCellsAsTheLensOpens) {
  constexpr double kSpacing = 0.01;
  const auto centres = JitteredGrid(12, kSpacing, 0.3, 8);
  const auto total_difference = [&](double diameter, LensWeights a, LensWeights b) {
    const RenderCamera frame = Frame(0.5 * diameter);
    const auto of_a = SharesOf(FrameWeights(frame, centres, a, Pool()), centres.size(), 0, 0);
    const auto of_b = SharesOf(FrameWeights(frame, centres, b, Pool()), centres.size(), 0, 0);
    double sum = 0;
    for (size_t i = 0; i < centres.size(); ++i) sum += std::abs(of_a[i] - of_b[i]);
    return sum;
  };
  EXPECT_EQ(total_difference(0.6 * kSpacing, LensWeights::kAuto, LensWeights::kHat), 0);
  EXPECT_EQ(total_difference(6 * kSpacing, LensWeights::kAuto, LensWeights::kArea), 0);
  const double to_hats = total_difference(1.4 * kSpacing, LensWeights::kAuto, LensWeights::kHat);
  const double to_cells = total_difference(1.4 * kSpacing, LensWeights::kAuto, LensWeights::kArea);
  const double whole = total_difference(1.4 * kSpacing, LensWeights::kHat, LensWeights::kArea);
  EXPECT_GT(to_hats, 0.02);
  EXPECT_GT(to_cells, 0.02);
  EXPECT_NEAR(to_hats + to_cells, whole, 0.02);
  // A pinhole has only hats.
  EXPECT_EQ(FrameWeights(Frame(0), centres, LensWeights::kAuto, Pool()).hat_share(), 1);
  double last = 1;
  for (double distances = 0; distances < 4; distances += 0.01) {
    const double share = AutoHatShare(distances, 1);
    EXPECT_LE(share, last);
    EXPECT_LT(last - share, 0.025);
    last = share;
  }
  EXPECT_EQ(last, 0);
}

TEST(FrameWeights, NoCamerasAndTiltedHorizonsAreNoTrouble) {
  EXPECT_EQ(FrameWeights(Frame(0.1), {}, LensWeights::kArea, Pool()).columns(), 1);
  RenderCamera frame = Frame(0.1, 0.05);
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {RadiansFromDegrees(80), 0});
  const auto centres = JitteredGrid(10, 0.02, 0.2, 7);
  const FrameWeights weights(frame, centres, LensWeights::kArea, Pool());
  const auto takes = [&](size_t i) { return weights.TakesPart(i); };
  size_t count = 0;
  for (size_t i = 0; i < centres.size(); ++i) count += takes(i) ? 1 : 0;
  EXPECT_GT(count, 20u);
}

}  // namespace
}  // namespace lf
