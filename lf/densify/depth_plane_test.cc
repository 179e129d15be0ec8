// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_plane.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lf/densify/depth_sweep.h"
#include "lf/densify/matching_row.h"
#include "lf/densify/semi_global.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

constexpr InverseDepths kRange = {0.1, 1.1};
constexpr double kBaseline = 0.06;  // 6 px of shift per unit of inverse depth

// The images of 3 x 3 cameras, the middle one first.
std::vector<WorkingImage> NineImages(const std::vector<Wall>& walls) {
  std::vector<WorkingImage> images{ImageOfWalls(CameraAt(0, 0), walls)};
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (x != 0 || y != 0)
        images.push_back(ImageOfWalls(CameraAt(x * kBaseline, y * kBaseline), walls));
  return images;
}

std::vector<SweepView> ViewsOf(const std::vector<WorkingImage>& images) {
  std::vector<SweepView> views;
  for (size_t i = 1; i < images.size(); ++i) views.push_back(ViewFrom(images[0], images[i]));
  return views;
}

// The cost of one pixel and inverse depth, by the words of matching_costs.h.
int CostByDefinition(const WorkingImage& reference, std::span<const SweepView> views, int x, int y,
                     float z) {
  const auto difference = [&](const SweepView& view, int i, int j) {
    const PairMap::Place place =
        view.from_reference.At(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f, z);
    const Image<uint16_t>& tones = view.image->compared;
    const float u = place.u_px - 0.5f, v = place.v_px - 0.5f;
    const auto width = static_cast<float>(tones.width()),
               height = static_cast<float>(tones.height());
    if (!(place.w > 0 && u > -1 && v > -1 && u < width && v < height))
      return MatchingCosts::kMost * 7 / 12;
    const float near_u = std::clamp(u, 0.0f, width - 1 - 1.0f / 1024);
    const float near_v = std::clamp(v, 0.0f, height - 1 - 1.0f / 1024);
    const int left = static_cast<int>(near_u), top = static_cast<int>(near_v);
    const int right = static_cast<int>((near_u - static_cast<float>(left)) * 32);
    const int below = static_cast<int>((near_v - static_cast<float>(top)) * 32);
    int sum = 0;
    for (int c = 0; c < 3; ++c) {
      const auto column = [&](int at) {
        return (tones.at(at, top, c) * (32 - below) + tones.at(at, top + 1, c) * below) >> 2;
      };
      const int tone = (column(left) * (32 - right) + column(left + 1) * right) >> 8;
      sum += std::abs(tone - reference.compared.at(i, j, c));
    }
    return MatchingCosts::kPerTone * std::min(sum, MatchingCosts::kMostDifference);
  };
  std::vector<int> means;
  for (const SweepView& view : views) {
    int sum = 0;
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i)
        sum += difference(view, std::clamp(i, 0, reference.width() - 1),
                          std::clamp(j, 0, reference.height() - 1));
    means.push_back(sum * 7282 >> 16);
  }
  int least = MatchingCosts::kMost;
  for (int side = -1; side < 8; ++side) {
    const Vec2 towards(std::cos(side * kPi / 4), std::sin(side * kPi / 4));
    int sum = 0, count = 0;
    for (size_t i = 0; i < views.size(); ++i) {
      if (side >= 0 && views[i].direction.dot(towards) < 0.2) continue;
      sum += means[i];
      ++count;
    }
    if (count >= 2) least = std::min(least, sum * ((65536 + count - 1) / count) >> 16);
  }
  return least;
}

TEST(MatchingCosts, EqualTheirDefinitionOnAllInstructionSets) {
  const std::vector<WorkingImage> images = NineImages({{2, 0.1, 1}, {5, INFINITY, 2}});
  const std::vector<SweepView> views = ViewsOf(images);
  constexpr int kPlanes = 9;
  ForEachTarget([&] {
    for (const PixelRect& rect : {PixelRect{0, 0, 96, 5}, PixelRect{50, 61, 96, 64}}) {
      MatchingCosts costs;
      ComputeMatchingCosts(images[0], views, kRange, kPlanes, rect, &costs);
      for (int y = rect.y_begin; y < rect.y_end; ++y)
        for (int x = rect.x_begin; x < rect.x_end; ++x)
          for (int plane = 0; plane < kPlanes; ++plane) {
            const double z =
                kRange.least + plane * (kRange.greatest - kRange.least) / (kPlanes - 1);
            ASSERT_EQ(costs.At(x - rect.x_begin, y - rect.y_begin)[plane],
                      CostByDefinition(images[0], views, x, y, static_cast<float>(z)))
                << x << " " << y << " " << plane;
          }
    }
  });
}

// The sums of semi-global matching, by its definition.
std::vector<int> SumsByDefinition(const MatchingCosts& costs, const Image<uint16_t>& tones) {
  const int width = costs.rect.width(), height = costs.rect.height(), planes = costs.stride;
  std::vector<int> sums(static_cast<size_t>(width) * height * planes);
  const auto index = [&](int x, int y) { return (static_cast<size_t>(y) * width + x) * planes; };
  for (const auto& [dx, dy] :
       {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {-1, 0}, {0, -1}, {-1, -1}, {1, -1}}) {
    std::vector<int> path(sums.size());
    const bool is_forward = dy > 0 || (dy == 0 && dx > 0);
    for (int k = 0; k < width * height; ++k) {
      const int y = (is_forward ? k : width * height - 1 - k) / width;
      const int along = k % width;
      const int x = dx >= 0 ? along : width - 1 - along;
      const int from_x = x - dx, from_y = y - dy;
      const uint8_t* cost = costs.At(x, y);
      int* out = path.data() + index(x, y);
      const bool is_first = from_x < 0 || from_x >= width || from_y < 0 || from_y >= height;
      const int* last = is_first ? nullptr : path.data() + index(from_x, from_y);
      const int least = is_first ? 0 : *std::min_element(last, last + planes);
      for (int j = 0; j < planes; ++j) {
        out[j] = cost[j];
        if (is_first) continue;
        int difference = 0;
        for (int c = 0; c < 3; ++c)
          difference += std::abs(tones.at(x, y, c) - tones.at(from_x, from_y, c));
        int best = std::min(
            last[j], least + std::max(kSmallStep + 1, kLargeStep / (1 + difference / 3 / 6)));
        if (j > 0) best = std::min(best, last[j - 1] + kSmallStep);
        if (j + 1 < planes) best = std::min(best, last[j + 1] + kSmallStep);
        out[j] += best - least;
      }
    }
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += path[i];
  }
  return sums;
}

TEST(SemiGlobal, ChoosesThePlaneOfTheLeastSumOnAllInstructionSets) {
  const std::vector<WorkingImage> images = NineImages({{2, 0.1, 1}, {5, INFINITY, 2}});
  MatchingCosts costs;
  constexpr int kPlanes = 17;
  ComputeMatchingCosts(images[0], ViewsOf(images), kRange, kPlanes, {0, 0, 96, 64}, &costs);
  const std::vector<int> sums = SumsByDefinition(costs, images[0].tones);
  ForEachTarget([&] {
    const ChosenPlanes chosen = ChoosePlanes(costs, images[0].tones, true);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        const int* of_pixel = sums.data() + (static_cast<size_t>(y) * 96 + x) * costs.stride;
        const int best =
            static_cast<int>(std::min_element(of_pixel, of_pixel + kPlanes) - of_pixel);
        ASSERT_NEAR(chosen.place.at(x, y), best, 0.501) << x << " " << y;
        ASSERT_EQ(chosen.cost.at(x, y), costs.At(x, y)[best]);
        int other = 1 << 20;
        for (int j = 0; j < kPlanes; ++j)
          if (std::abs(j - best) > 2) other = std::min(other, of_pixel[j]);
        ASSERT_EQ(chosen.lead.at(x, y), (other - of_pixel[best]) / 8);
      }
  });
}

// Returns the share of pixels whose depth is right, within a tenth of a pixel of shift. Pixels at
// the border do not count, where the means of ComparedTones() are those of other surroundings.
double RightShare(const DepthPlane& plane, const PinholeCamera& camera,
                  const std::vector<Wall>& walls) {
  constexpr double kTolerance = 0.1 / (100 * kBaseline);
  constexpr int kBorder = 4;
  int right = 0, all = 0;
  for (int y = kBorder; y < plane.height() - kBorder; ++y)
    for (int x = kBorder; x < plane.width() - kBorder; ++x, ++all) {
      Vec3 point;
      const Wall* wall = WallAt(camera, walls, x + 0.5, y + 0.5, &point);
      if (std::abs(kRange.Of(plane.at(x, y)) - 1 / wall->depth) <= kTolerance) ++right;
    }
  return static_cast<double>(right) / all;
}

TEST(SweepDepths, FindsTheDepthOfATexturedWall) {
  const std::vector<Wall> walls = {{2.3, INFINITY, 1}};
  const std::vector<WorkingImage> images = NineImages(walls);
  const DepthPlane plane = SweepDepths(images[0], ViewsOf(images), kRange, 24);
  EXPECT_GT(RightShare(plane, images[0].camera, walls), 0.98);
}

TEST(SweepDepths, FindsBothDepthsBesideAnOutline) {
  const std::vector<Wall> walls = {{1.5, 0.1, 1}, {6, INFINITY, 2}};
  const std::vector<WorkingImage> images = NineImages(walls);
  const DepthPlane plane = SweepDepths(images[0], ViewsOf(images), kRange, 24);
  EXPECT_GT(RightShare(plane, images[0].camera, walls), 0.95);
}

// The images of 3 x 3 cameras of a disk, the middle one first.
std::vector<WorkingImage> NineOfDisk(const Disk& disk) {
  std::vector<WorkingImage> images{ImageOfDisk(CameraAt(0, 0), disk)};
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (x != 0 || y != 0)
        images.push_back(ImageOfDisk(CameraAt(x * kBaseline, y * kBaseline), disk));
  return images;
}

TEST(MatchingCosts, TransparentPixelsMatchNeitherColouredNorMaskedOnes) {
  const uint16_t transparent[4] = {0, 0, 0, kTransparentTone}, black[4] = {0, 0, 0, 255};
  std::vector<uint16_t> costs(1);
  const auto cost = [&](const uint16_t* reference, const uint16_t* seen) {
    WorkingImage view = ImageOfDisk(CameraAt(0, 0, 8, 8), {});
    for (size_t i = 0; i < view.tones.pixels().size(); ++i)
      view.tones.pixels()[i] = seen[i % LfPixels::kRgbLanes];
    CompareRow(reference, 4, 4, 1, PairMap(), 1, {view.tones.row(0), 8, 8}, costs.data());
    return costs[0];
  };
  const uint16_t masked[4] = {0, 0, 0, 0};
  EXPECT_EQ(cost(transparent, transparent), 0);
  EXPECT_EQ(cost(transparent, black), MatchingCosts::kMost);
  EXPECT_EQ(cost(black, transparent), MatchingCosts::kMost);
  EXPECT_EQ(cost(masked, transparent), MatchingCosts::kMost);
}

TEST(MatchingCosts, APixelIsNotWhereAnyViewIsEmpty) {
  const std::vector<WorkingImage> images = NineOfDisk({});
  const std::vector<SweepView> views = ViewsOf(images);
  constexpr int kPlanes = 21;
  MatchingCosts costs;
  ComputeMatchingCosts(images[0], views, kRange, kPlanes, {0, 0, 96, 64}, &costs);
  int carved = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x)
      for (int plane = 0; plane < kPlanes; ++plane) {
        const auto z = static_cast<float>(kRange.least + plane * 0.05);
        bool is_empty = false;
        for (const SweepView& view : views)
          is_empty |= IsMarkedAt(view.image->empty,
                                 view.from_reference.At(static_cast<float>(x) + 0.5f,
                                                        static_cast<float>(y) + 0.5f, z));
        const bool is_carved = is_empty && !IsTransparent(&images[0].tones.at(x, y));
        ASSERT_EQ(costs.At(x, y)[plane] == MatchingCosts::kCarved, is_carved) << x << " " << y;
        carved += is_carved;
      }
  EXPECT_GT(carved, 500);
}

TEST(ChoosePlanes, TheDepthMayStepAtTheOutlineOfADarkObject) {
  constexpr int kWidth = 8, kPlanes = 32, kLeft = 10, kRight = 25;
  MatchingCosts costs{{0, 0, kWidth, 1}, kPlanes, kPlanes, {}};
  costs.costs.resize(size_t{kWidth} * kPlanes);
  Image<uint16_t> tones(kWidth, 1, LfPixels::kRgbLanes);
  const auto is_left = [](int x) { return x < kWidth / 2; };
  for (int x = 0; x < kWidth; ++x) {
    uint8_t* of_pixel = costs.costs.data() + size_t{kPlanes} * static_cast<size_t>(x);
    std::fill_n(of_pixel, kPlanes, static_cast<uint8_t>(is_left(x) ? 200 : 20));
    of_pixel[is_left(x) ? kLeft : kRight] = 0;
    tones.at(x, 0, LfPixels::kRayLane) = is_left(x) ? 255 : kTransparentTone;
  }
  const ChosenPlanes chosen = ChoosePlanes(costs, tones, false);
  for (int x = 0; x < kWidth; ++x)
    EXPECT_NEAR(chosen.place.at(x, 0), is_left(x) ? kLeft : kRight, 0.5) << x;
}

TEST(SweepDepths, FindsTheDepthOfADarkDiskByItsOutline) {
  const Disk disk = {2, 0.3, 0, false};
  const std::vector<WorkingImage> images = NineOfDisk(disk);
  const DepthPlane plane = SweepDepths(images[0], ViewsOf(images), kRange, 24);
  for (int y = 4; y < 60; ++y)
    for (int x = 4; x < 92; ++x)
      if (InsidePx(images[0].camera, disk, x, y) > 0) {
        ASSERT_NEAR(kRange.Of(plane.at(x, y)), 0.5, 0.06) << x << " " << y;
      }
}

TEST(DepthPlane, TransparentPixelsTakeTheDepthOfTheObjectBesideThem) {
  const Disk disk;
  const std::vector<WorkingImage> images = NineOfDisk(disk);
  DepthPlane plane(96, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x)
      plane.at(x, y) =
          kRange.NumberOf(IsTransparent(&images[0].tones.at(x, y)) ? 0.2 : 1 / disk.depth);
  const std::vector<DepthView> itself(2, {&plane, PairMap()});
  const Image<uint8_t> agreeing = CountAgreeing(plane, images[0].tones, itself, kRange, 0.05);
  EXPECT_EQ(agreeing.at(48, 32), 2);
  EXPECT_EQ(agreeing.at(4, 32), 0);
  const DepthPlane filled = FillDisagreeing(plane, agreeing, 2, images[0].tones, kRange, 6);
  EXPECT_EQ(filled.at(4, 32), kRange.NumberOf(1 / disk.depth));
}

TEST(DepthPlane, WrongDepthsAreFoundAndReplacedByThoseOfTheBackground) {
  const std::vector<Wall> walls = {{2, INFINITY, 1}};
  const std::vector<WorkingImage> images = NineImages(walls);
  DepthPlane right(96, 64);
  std::fill(right.pixels().begin(), right.pixels().end(), kRange.NumberOf(0.5));
  DepthPlane spoiled = right;
  for (int y = 20; y < 30; ++y)
    for (int x = 40; x < 50; ++x) spoiled.at(x, y) = kRange.NumberOf(1.0);
  std::vector<DepthView> views;
  for (size_t i = 1; i < images.size(); ++i)
    views.push_back({&right, MapBetween(images[0].camera, images[i].camera)});
  const Image<uint8_t> agreeing = CountAgreeing(spoiled, images[0].tones, views, kRange, 0.05);
  for (int y = 8; y < 56; ++y)
    for (int x = 8; x < 88; ++x)
      ASSERT_EQ(agreeing.at(x, y), x >= 40 && x < 50 && y >= 20 && y < 30 ? 0 : 8) << x << " " << y;
  const DepthPlane filled = FillDisagreeing(spoiled, agreeing, 2, images[0].tones, kRange, 6);
  for (int y = 20; y < 30; ++y)
    for (int x = 40; x < 50; ++x) ASSERT_EQ(filled.at(x, y), right.at(x, y));
}

TEST(DepthPlane, TonesOutweighThePreferenceForFarDepthsAlsoIfCamerasAreFarApart) {
  constexpr int kMiddle = 48, kRow = 32;
  DepthPlane plane(96, 64);
  Image<uint16_t> tones(96, 64, LfPixels::kRgbLanes);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      plane.at(x, y) = kRange.NumberOf(x <= kMiddle ? 1.0 : 0.2);
      for (int c = 0; c < 3; ++c) tones.at(x, y, c) = x <= kMiddle ? 100 : 130;
    }
  Image<uint8_t> agreeing(96, 64, 1, 8);
  agreeing.at(kMiddle, kRow) = 0;
  for (const double shift_per_depth_px : {6.0, 200.0}) {
    const DepthPlane filled =
        FillDisagreeing(plane, agreeing, 2, tones, kRange, shift_per_depth_px);
    EXPECT_EQ(filled.at(kMiddle, kRow), kRange.NumberOf(1.0)) << shift_per_depth_px;
  }
}

}  // namespace
}  // namespace lf
