// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/guess_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace lf {
namespace {

using Grid = std::array<int, 2>;

// A scene of two surfaces before each other, each with a texture of its own.
class Scene {
 public:
  explicit Scene(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / std::mt19937::max();
    };
    for (Wave& wave : waves_)
      wave = {between(-1, 1), between(-1, 1), between(0, 7), between(5, 40)};
  }
  // The light at a pixel of the view (u, v): a card of disparity 1 before a wall of disparity -1/2.
  float At(double x, double y, int u, int v) const {
    const bool is_card = std::abs(x - u - 25) < 12 && std::abs(y - v - 20) < 9;
    return is_card ? 400 + Wall(x - u, y - v) : Wall(x + u / 2.0, y + v / 2.0);
  }

 private:
  struct Wave {
    double across, down, phase, height;
  };
  // Waves, which have no period in common.
  float Wall(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_)
      sum += wave.height * std::sin(wave.across * x + wave.down * y + wave.phase);
    return static_cast<float>(sum);
  }

  std::array<Wave, 40> waves_;
};

Image<float> Mosaic(Grid grid, int width, int height) {
  const Scene scene(1);
  Image<float> picture(grid[0] * width, grid[1] * height);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      picture.at(x, y) = scene.At(x % width, y % height, x / width, y / height);
  return picture;
}

Image<float> Lenslets(Grid grid, int width, int height) {
  const Scene scene(2);
  Image<float> picture(grid[0] * width, grid[1] * height);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      picture.at(x, y) = scene.At(x / grid[0], y / grid[1], x % grid[0], y % grid[1]);
  return picture;
}

TEST(GuessGrid, NamesMayEndInColumnsAndRows) {
  EXPECT_EQ(GridAtEndOfName("scene_5x5.png"), (Grid{5, 5}));
  EXPECT_EQ(GridAtEndOfName("17X9.tif"), (Grid{17, 9}));
  EXPECT_EQ(GridAtEndOfName("a-1x8.png"), (Grid{1, 8}));
  for (const char* name : {"scene.png", "5x5_scene.png", "box5.png", "scene_1x1.png", "a_0x5.png",
                           "a_1920x1080.png", "mix4x4.png", "x5.png", ""})
    EXPECT_FALSE(GridAtEndOfName(name)) << name;
}

TEST(GuessGrid, FindsViewsSideBySide) {
  for (const Grid& grid : {Grid{5, 5}, Grid{4, 3}, Grid{6, 2}, Grid{9, 9}})
    EXPECT_EQ(FindTiles(Mosaic(grid, 64, 48)), grid) << grid[0] << " x " << grid[1];
}

TEST(GuessGrid, FindsViewsUnderLenslets) {
  for (const Grid& grid : {Grid{5, 5}, Grid{4, 3}, Grid{9, 9}, Grid{14, 14}}) {
    EXPECT_EQ(FindLenslets(Lenslets(grid, 64, 48)), grid) << grid[0] << " x " << grid[1];
    EXPECT_FALSE(FindTiles(Lenslets(grid, 64, 48))) << grid[0] << " x " << grid[1];
  }
}

TEST(GuessGrid, TellsQuiltsFromGridsOfCameras) {
  const Grid grid = {4, 3};
  Image<float> quilt(4 * 64, 3 * 48);
  const Scene scene(4);
  for (int y = 0; y < quilt.height(); ++y)
    for (int x = 0; x < quilt.width(); ++x)
      quilt.at(x, y) = scene.At(x % 64, y % 48, (2 - y / 48) * 4 + x / 64, 0);
  EXPECT_FALSE(HoldsGridOfCameras(quilt, grid));
  EXPECT_TRUE(HoldsGridOfCameras(Mosaic(grid, 64, 48), grid));
  EXPECT_FALSE(HoldsGridOfCameras(Mosaic({4, 1}, 64, 48), {4, 1}));
}

TEST(GuessGrid, OnePhotographIsNoGrid) {
  const Image<float> photograph = Mosaic({1, 1}, 480, 360);
  EXPECT_FALSE(FindTiles(photograph));
  EXPECT_FALSE(FindLenslets(photograph));
  EXPECT_FALSE(FindTiles(Image<float>(400, 300)));
  EXPECT_FALSE(FindLenslets(Image<float>(400, 300)));
  EXPECT_FALSE(FindTiles(Image<float>(1, 1)));
  EXPECT_FALSE(FindLenslets(Image<float>(1, 1)));
}

TEST(GuessGrid, BlocksOfCompressionAreNoLenslets) {
  // The mean of each block of 16 pixels is off, as in strongly compressed JPEGs.
  Image<float> photograph = Mosaic({1, 1}, 480, 352);
  std::mt19937 random(3);
  std::vector<float> offsets(30 * 22);
  for (float& offset : offsets) offset = static_cast<float>(random() % 20);
  for (int y = 0; y < photograph.height(); ++y)
    for (int x = 0; x < photograph.width(); ++x)
      photograph.at(x, y) += offsets[static_cast<size_t>(y / 16 * 30 + x / 16)];
  EXPECT_FALSE(FindLenslets(photograph));
  EXPECT_FALSE(FindTiles(photograph));
}

}  // namespace
}  // namespace lf
