// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lf/densify/semi_global.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace depth_sweep_test {
namespace {

constexpr InverseDepths kRange = {0.1, 1.1};
constexpr double kBaseline = 0.12;  // 12 px of shift per unit of inverse depth
constexpr int kWidth = 420, kHeight = 75;

std::vector<WorkingImage> LargeImages(const std::vector<Wall>& walls) {
  std::vector<WorkingImage> images;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    images.push_back(ImageOfWalls(CameraAt(x * kBaseline, y * kBaseline, kWidth, kHeight), walls));
  return images;
}

std::vector<SweepView> ViewsOf(const std::vector<WorkingImage>& images) {
  std::vector<SweepView> views;
  for (size_t i = 1; i < images.size(); ++i) views.push_back(ViewFrom(images[0], images[i]));
  return views;
}

TEST(SweepDepths, ComparesFewDepthsInALargeImageAndFindsBothBesideOutlines) {
  EXPECT_EQ(ComparedShare(96, 64), 1);
  EXPECT_LT(ComparedShare(kWidth, kHeight), 0.5);
  const std::vector<Wall> walls = {{1.2, 0.1, 1}, {6, INFINITY, 2}};
  const std::vector<WorkingImage> images = LargeImages(walls);
  const DepthPlane plane = SweepDepths(images[0], ViewsOf(images), kRange, 60);
  constexpr double kTolerance = 0.1 / (100 * kBaseline);
  int right = 0, near_right = 0, near_count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      Vec3 point;
      const Wall* wall = WallAt(images[0].camera, walls, x + 0.5, y + 0.5, &point);
      const bool is_right = std::abs(kRange.Of(plane.at(x, y)) - 1 / wall->depth) <= kTolerance;
      right += is_right;
      if (std::abs(x - (kWidth / 2 + 100 * 0.1 / 1.2)) > 20) continue;
      near_right += is_right;
      ++near_count;
    }
  EXPECT_GT(right, 0.97 * kWidth * kHeight);
  EXPECT_GT(near_right, 0.9 * near_count);
}

// The sums of paths, by their definition: a plane that a pixel does not have costs nothing and is
// on no path.
TEST(SweepDepths, FindsTheDepthOfALargeCutOutObjectUpToItsOutline) {
  constexpr Disk kDisk{2, 2, 1, true};
  std::vector<WorkingImage> images;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    images.push_back(
        ImageOfDisk(CameraAt(x * kBaseline, y * kBaseline, kWidth, kWidth / 2), kDisk));
  const DepthPlane plane = SweepDepths(images[0], ViewsOf(images), kRange, 40);
  int right = 0, beside = 0, count = 0, beside_count = 0;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      const double inside_px = InsidePx(images[0].camera, kDisk, x, y);
      if (inside_px < 1) continue;
      const bool is_right =
          std::abs(kRange.Of(plane.at(x, y)) - 1 / kDisk.depth) <= 0.2 / (100 * kBaseline);
      right += is_right;
      ++count;
      if (inside_px > 8) continue;
      beside += is_right;
      ++beside_count;
    }
  EXPECT_GT(right, 0.98 * count);
  EXPECT_GT(beside, 0.9 * beside_count);
}

// Cost of a plane that a pixel does not have.
constexpr int kNone = 1 << 20;
constexpr int kPlanes = 12, kColumns = 11, kRows = 7, kSide = 4;

const CostBlocks::Block& BlockOf(const CostBlocks& blocks, int x, int y) {
  return blocks
      .blocks[static_cast<size_t>(y / kSide * CostBlocks::CountAlong(kColumns, kSide) + x / kSide)];
}

int CostOf(const CostBlocks& blocks, int x, int y, int plane) {
  const CostBlocks::Block& block = BlockOf(blocks, x, y);
  for (const PlaneSet::Run& run : block.planes.runs())
    if (plane >= run.first && plane < run.End())
      return block.costs.At(x % kSide, y % kSide)[run.EntryOf(plane)];
  return kNone;
}

// The sums of semi-global matching, by its definition.
std::vector<int> SumsByDefinition(const CostBlocks& blocks) {
  const auto index = [](int x, int y) { return (static_cast<size_t>(y) * kColumns + x) * kPlanes; };
  std::vector<int> sums(index(0, kRows));
  for (const auto& [dx, dy] :
       {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {-1, 0}, {0, -1}, {-1, -1}, {1, -1}}) {
    std::vector<int> path(sums.size());
    for (int k = 0; k < kColumns * kRows; ++k) {
      const int at = dy > 0 || (dy == 0 && dx > 0) ? k : kColumns * kRows - 1 - k;
      const int x = at % kColumns, y = at / kColumns, from_x = x - dx, from_y = y - dy;
      const bool is_first = from_x < 0 || from_x >= kColumns || from_y < 0 || from_y >= kRows;
      const auto last = [&](int plane) {
        return plane < 0 || plane >= kPlanes ? kNone : path[index(from_x, from_y) + plane];
      };
      int least = kNone;
      for (int j = 0; j < kPlanes && !is_first; ++j) least = std::min(least, last(j));
      for (int j = 0; j < kPlanes; ++j) {
        int& out = path[index(x, y) + j];
        out = CostOf(blocks, x, y, j);
        if (is_first || out == kNone) continue;
        out += std::min({last(j), last(j - 1) + kSmallStep, last(j + 1) + kSmallStep,
                         least + kLargeStep}) -
               least;
      }
    }
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += path[i];
  }
  return sums;
}

TEST(ChoosePlanes, PathsGoThroughBlocksOfDifferentPlanes) {
  CostBlocks blocks{{0, 0, kColumns, kRows}, kSide, {}};
  for (int y = 0; y < kRows; y += kSide)
    for (int x = 0; x < kColumns; x += kSide) {
      std::vector<uint8_t> marks(kPlanes);
      for (int j = 0; j < 4; ++j) marks[static_cast<size_t>((x + y) / 4 + j)] = 1;
      if (x > 0) marks[kPlanes - 1] = marks[kPlanes - 2] = 1;
      blocks.blocks.push_back({PlaneSet::Marked(marks), {}});
      MatchingCosts& costs = blocks.blocks.back().costs;
      costs.rect = {x, y, std::min(x + kSide, kColumns), std::min(y + kSide, kRows)};
      costs.planes = blocks.blocks.back().planes.entries();
      costs.stride = MatchingCosts::StrideOf(costs.planes);
      costs.costs.resize(
          static_cast<size_t>(costs.rect.width()) * costs.rect.height() * costs.stride,
          uint8_t{MatchingCosts::kCarved});
      for (int pixel = 0; pixel < costs.rect.width() * costs.rect.height(); ++pixel)
        for (const PlaneSet::Run& run : blocks.blocks.back().planes.runs())
          for (int j = 0; j < run.count; ++j)
            costs.costs[static_cast<size_t>(pixel) * costs.stride + run.entry + j] =
                static_cast<uint8_t>((pixel * 37 + (run.first + j) * 91 + x * 13 + y * 7) % 50);
    }
  const Image<uint16_t> tones(kColumns, kRows, LfPixels::kRgbLanes);
  const ChosenPlanes chosen = ChoosePlanes(blocks, tones);
  const std::vector<int> sums = SumsByDefinition(blocks);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const auto of_pixel = sums.begin() + (static_cast<ptrdiff_t>(y) * kColumns + x) * kPlanes;
      const auto best = std::min_element(of_pixel, of_pixel + kPlanes) - of_pixel;
      ASSERT_NEAR(chosen.place.at(x, y), static_cast<double>(best), 0.501) << x << " " << y;
      ASSERT_EQ(chosen.cost.at(x, y), CostOf(blocks, x, y, static_cast<int>(best)));
    }
}

}  // namespace
}  // namespace depth_sweep_test
}  // namespace lf
