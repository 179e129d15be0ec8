// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/compared_tones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "lf/densify/matching_costs.h"
#include "lf/densify/semi_global.h"
#include "lf/densify/test_world.h"

namespace lf {
namespace {

// By the words of compared_tones.h.
int ByDefinition(const Image<uint16_t>& tones, int x, int y, int lane) {
  int sum = 0, count = 0;
  for (int j = std::max(y - 4, 0); j <= std::min(y + 4, tones.height() - 1); ++j)
    for (int i = std::max(x - 4, 0); i <= std::min(x + 4, tones.width() - 1); ++i) {
      if (tones.at(i, j, 3) == 0 || IsTransparent(&tones.at(i, j))) continue;
      sum += tones.at(i, j, lane);
      ++count;
    }
  const int half_mean = (sum + count) / (2 * count);
  return std::clamp(tones.at(x, y, lane) - half_mean + 64, 0, 255);
}

TEST(ComparedTones, EqualTheirDefinition) {
  const WorkingImage image = ImageOfDisk(CameraAt(0, 0, 40, 30), {2, 0.2, 1, true});
  Image<uint16_t> tones = image.tones;
  for (int lane = 0; lane < 4; ++lane) tones.at(22, 14, lane) = 0;  // masked
  const Image<uint16_t> compared = ComparedTones(tones);
  int changed = 0;
  for (int y = 0; y < tones.height(); ++y)
    for (int x = 0; x < tones.width(); ++x) {
      const bool is_shown = tones.at(x, y, 3) != 0 && !IsTransparent(&tones.at(x, y));
      for (int lane = 0; lane < 3; ++lane) {
        const int expected = is_shown ? ByDefinition(tones, x, y, lane) : tones.at(x, y, lane);
        ASSERT_EQ(compared.at(x, y, lane), expected) << x << " " << y << " " << lane;
        changed += compared.at(x, y, lane) != tones.at(x, y, lane);
      }
      ASSERT_EQ(compared.at(x, y, 3), tones.at(x, y, 3));
    }
  EXPECT_GT(changed, 300);
}

TEST(ComparedTones, HoldBlackAndWhite) {
  Image<uint16_t> tones(30, 20, 4, 255);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 15; ++x)
      for (int lane = 0; lane < 3; ++lane) tones.at(x, y, lane) = 0;
  const Image<uint16_t> compared = ComparedTones(tones);
  EXPECT_EQ(compared.at(2, 10, 0), 64);    // black among black
  EXPECT_EQ(compared.at(27, 10, 0), 191);  // white among white
  EXPECT_EQ(compared.at(14, 10, 0), 7);    // black beside four columns of nine that are white
  EXPECT_EQ(compared.at(15, 10, 0), 248);  // white beside four that are black
  EXPECT_EQ(ComparedTones(Image<uint16_t>(1, 1, 4, 255)).at(0, 0, 1), 191);
}

// Returns the share of the pixels, without a border, whose depth is within a plane of `place`.
double RightShare(const std::vector<WorkingImage>& images, const InverseDepths& range, int planes,
                  float place) {
  std::vector<SweepView> views;
  for (size_t i = 1; i < images.size(); ++i) views.push_back(ViewFrom(images[0], images[i]));
  MatchingCosts costs;
  const int width = images[0].width(), height = images[0].height();
  ComputeMatchingCosts(images[0], views, range, planes, {0, 0, width, height}, &costs);
  const ChosenPlanes chosen = ChoosePlanes(costs, images[0].tones, false);
  constexpr int kBorder = 8;
  int right = 0, all = 0;
  for (int y = kBorder; y < height - kBorder; ++y)
    for (int x = kBorder; x < width - kBorder; ++x, ++all)
      right += std::abs(chosen.place.at(x, y) - place) <= 1;
  return static_cast<double>(right) / all;
}

// Photographs of a wall, of which each is darker by `darker` tones than the one before.
//   as_recorded  true: their tones are compared as they are
std::vector<WorkingImage> Photographs(int darker, bool as_recorded) {
  std::vector<WorkingImage> images;
  for (const double x : {0.0, -0.06, 0.06, -0.12, 0.12}) {
    WorkingImage image = ImageOfWalls(CameraAt(x, 0), {{2, INFINITY, 1}});
    const int less = darker * static_cast<int>(images.size());
    for (int row = 0; row < image.height(); ++row)
      for (int column = 0; column < image.width(); ++column)
        for (int lane = 0; lane < 3; ++lane) {
          uint16_t& tone = image.tones.at(column, row, lane);
          tone = static_cast<uint16_t>(120 + tone / 4 - less);
        }
    image.compared = as_recorded ? image.tones : ComparedTones(image.tones);
    images.push_back(std::move(image));
  }
  return images;
}

TEST(ComparedTones, DepthsAreFoundThoughLightDiffers) {
  const InverseDepths range{0.1, 1.1};
  EXPECT_GT(RightShare(Photographs(0, false), range, 21, 8), 0.98);
  EXPECT_GT(RightShare(Photographs(5, false), range, 21, 8), 0.9);
  EXPECT_LT(RightShare(Photographs(5, true), range, 21, 8), 0.7);
}

}  // namespace
}  // namespace lf
