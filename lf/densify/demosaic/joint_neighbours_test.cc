// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "lf/densify/camera_chart.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr int kSide = 15;  // LF cameras along each side of a grid
constexpr uint32_t kMiddle = kSide * kSide / 2;
constexpr InverseDepths kRange{0.5, 0.55};  // in which a distance of 0.1 is a shift of 5 to 5.5 px

struct Grid {
  LightField field;
  std::vector<Vec3> centres;

  explicit Grid(double distance_w) {
    field.intrinsics = {CameraAt(0, 0).intrinsics};
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column) {
        LfCamera camera;
        camera.cam_from_world = CameraAt(distance_w * column, distance_w * row).cam_from_world;
        field.cameras.push_back(camera);
        field.image_names.push_back("");
        centres.push_back(
            field.Camera(LfImageId{static_cast<uint32_t>(centres.size())}).CentreWorld());
      }
  }
  double DistanceTo(uint32_t id) const { return (centres[id] - centres[kMiddle]).norm(); }
  std::vector<std::vector<uint32_t>> Compared() const {
    std::vector<uint32_t> all(field.size());
    std::iota(all.begin(), all.end(), 0U);
    return CompareWith(field, all, std::nullopt);
  }
};

// Returns the distances of the chosen LF cameras, the least first.
std::vector<double> Distances(const Grid& grid, const std::vector<ChosenNeighbour>& chosen) {
  std::vector<double> distances;
  for (const ChosenNeighbour& neighbour : chosen)
    distances.push_back(grid.DistanceTo(neighbour.id));
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(JointNeighbours, TheNearestAreChosenIfTheirParallaxIsLarge) {
  const Grid grid(0.1);
  const InverseDepths range{0.1, 1};
  const auto chosen = ChooseNeighbours(grid.field, grid.centres, kMiddle, range, 8);
  ASSERT_EQ(chosen.size(), 8U);
  EXPECT_LT(Distances(grid, chosen).back(), 0.15);
  for (const ChosenNeighbour& neighbour : chosen) EXPECT_NE(neighbour.id, kMiddle);
}

TEST(JointNeighbours, FartherOnesAreChosenIfNearOnesRecordTheSameColours) {
  const Grid grid(0.005);  // a shift of a quarter of a pixel
  const auto chosen = ChooseNeighbours(grid.field, grid.centres, kMiddle, kRange, 24);
  ASSERT_EQ(chosen.size(), 24U);
  // The 24 nearest ones lie up to 2.9 distances away, and show shifts up to half a pixel.
  std::set<std::pair<int, int>> phases;
  for (const ChosenNeighbour& neighbour : chosen) {
    const Vec3 away = (grid.centres[neighbour.id] - grid.centres[kMiddle]) / 0.005;
    phases.insert({static_cast<int>(std::lround(away.x() / 2 + 100)) % 4,
                   static_cast<int>(std::lround(away.y() / 2 + 100)) % 4});
  }
  EXPECT_GT(phases.size(), 9U);  // those of the 24 nearest ones
  EXPECT_GT(Distances(grid, chosen).back(), 4 * 0.005);
}

TEST(JointNeighbours, SamplesOfFarLfCamerasCountLess) {
  const Grid grid(0.1);
  auto chosen = ChooseNeighbours(grid.field, grid.centres, kMiddle, {0.1, 1}, 32);
  std::sort(chosen.begin(), chosen.end(), [&](const auto& a, const auto& b) {
    return grid.DistanceTo(a.id) < grid.DistanceTo(b.id);
  });
  EXPECT_NEAR(chosen[0].nearness, 1 / 1.4, 1e-5);
  EXPECT_LT(chosen.back().nearness, 0.35);
  for (size_t i = 1; i < chosen.size(); ++i)
    EXPECT_LE(chosen[i].nearness, chosen[i - 1].nearness + 1e-6F);
}

TEST(JointNeighbours, LfCamerasThatLookElsewhereAreNone) {
  Grid grid(0.1);
  for (uint32_t i = 0; i < grid.field.size(); ++i)
    if (i != kMiddle && i % 3 != 0)
      grid.field.cameras[i].cam_from_world.rotation = Vec3(-1, 1, -1).asDiagonal();
  for (const ChosenNeighbour& neighbour :
       ChooseNeighbours(grid.field, grid.centres, kMiddle, kRange, 32))
    EXPECT_EQ(neighbour.id % 3, 0U);
}

TEST(JointNeighbours, DepthsAreSearchedWithLfImagesThatTellSome) {
  const Grid dense(0.005), sparse(0.1);
  const InverseDepths range{0.1, 0.6};
  // Points move by a quarter of a pixel, and by five pixels, between neighbours.
  const auto far =
      FarEnoughForDepths(dense.field, dense.centres, std::nullopt, range, dense.Compared());
  double least = INFINITY;
  for (const uint32_t other : far[kMiddle])
    if (other != kMiddle) least = std::min(least, dense.DistanceTo(other));
  EXPECT_FALSE(far[kMiddle].empty());
  EXPECT_GT(least, 0.01);
  EXPECT_EQ(
      FarEnoughForDepths(sparse.field, sparse.centres, std::nullopt, range, sparse.Compared()),
      sparse.Compared());
}

}  // namespace
}  // namespace lf
