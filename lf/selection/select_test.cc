// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/select.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lf/selection/overlap.h"

namespace lf {
namespace {

// Returns 21 x 21 LF cameras with pitch 0.01 in the plane z = 0.
LightField Grid() {
  LightField field;
  field.intrinsics = {{100, 100, 25, 17.5, 0, 50, 35}};
  for (int row = -10; row <= 10; ++row)
    for (int column = -10; column <= 10; ++column) {
      LfCamera camera;
      camera.cam_from_world.translation = {-0.01 * column, -0.01 * row, 0};
      field.cameras.push_back(camera);
      field.image_names.push_back("x.png");
    }
  return field;
}

RenderCamera Frame(double radius_w, double x) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {100, 100, 25, 17.5, 0, 50, 35};
  frame.pinhole.cam_from_world.translation = {-x, 0, 0};
  frame.aperture = {radius_w, 0, 0};
  frame.focus_plane = {Vec3::UnitZ(), 2};
  return frame;
}

TEST(Select, TakesTheCamerasWithinTheLens) {
  ThreadPool pool(2);
  const LightField field = Grid();
  const std::vector<RenderCamera> frames = {Frame(0.0301, 0)};
  const auto images = SelectImages(ImageIndex(field), frames, {}, pool);
  EXPECT_EQ(images.size(), 29u);  // number of integer points within radius 3
  for (const SelectedImage& image : images) EXPECT_EQ(image.frame_count, 1u);
}

TEST(Select, TheOrderDependsOnTheSeedAlone) {
  const LightField grid = Grid();
  const std::vector<RenderCamera> frames = {Frame(0.05, 0), Frame(0.02, 0.03)};
  const auto order = [&](int threads, uint64_t seed) {
    ThreadPool pool(threads);
    std::vector<uint32_t> ids;
    for (const SelectedImage& image : SelectImages(ImageIndex(grid, seed), frames, {}, pool))
      ids.push_back(image.id.value);
    return ids;
  };
  EXPECT_EQ(order(1, 0), order(3, 0));
  EXPECT_NE(order(1, 0), order(1, 1));
  const auto a = order(1, 0), b = order(1, 1);
  EXPECT_EQ(std::set<uint32_t>(a.begin(), a.end()), std::set<uint32_t>(b.begin(), b.end()));
}

TEST(Select, BoundsHoldTheRectanglesOfAllFrames) {
  ThreadPool pool(1);
  const LightField grid = Grid();
  const std::vector<RenderCamera> frames = {Frame(0.03, 0), Frame(0.03, 0.02)};
  for (const SelectedImage& image : SelectImages(ImageIndex(grid), frames, {}, pool)) {
    PixelRect bounds;
    uint64_t rays = 0;
    for (const RenderCamera& frame : frames) {
      const PixelRect rect = ContributingRect(grid.Camera(image.id), frame);
      bounds = Bounds(bounds, rect);
      rays += static_cast<uint64_t>(rect.pixel_count());
    }
    EXPECT_EQ(image.rect, bounds);
    EXPECT_EQ(image.ray_count, rays);
  }
}

TEST(Select, PlacesAreThoseOfTheWholeLightFieldWhateverTheFrames) {
  ThreadPool pool(2);
  const LightField grid = Grid();
  const std::vector<RenderCamera> frames = {Frame(0.05, 0), Frame(0.03, 0.04)};
  const ImageRanks order = ShuffledRanks(grid.size(), 3);
  for (const auto& part : {std::span(frames), std::span(frames).first(1)}) {
    uint32_t last = 0;
    for (const SelectedImage& image : SelectImages(ImageIndex(grid, 3), part, {}, pool)) {
      EXPECT_EQ(order.of_images[image.id.value], image.rank);
      EXPECT_GE(image.rank, last);
      last = image.rank + 1;
    }
  }
}

// An index of only the LF images that contribute, with their ranks, gives the same result as an
// index of the whole light field.
TEST(Select, APartWithItsPlacesIsAsGoodAsTheWhole) {
  ThreadPool pool(2);
  const LightField grid = Grid();
  const std::vector<RenderCamera> frames = {Frame(0.05, 0), Frame(0.03, 0.02)};
  const ImageIndex whole(grid, 4);
  std::vector<SelectedImage> images = SelectImages(whole, frames, {}, pool);
  LightField part;
  part.intrinsics = grid.intrinsics;
  ImageRanks ranks{{}, whole.rank_end()};
  for (uint32_t i = 0; i < grid.size(); ++i) {
    const auto is_it = [i](const SelectedImage& image) { return image.id.value == i; };
    if (std::none_of(images.begin(), images.end(), is_it)) continue;
    part.cameras.push_back(grid.cameras[i]);
    part.image_names.push_back("x.png");
    ranks.of_images.push_back(whole.RankOf(LfImageId{i}));
  }
  const ImageIndex index(part, ranks);
  const auto again = SelectImages(index, frames, {}, pool);
  ASSERT_EQ(again.size(), images.size());
  for (size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(again[i].rank, images[i].rank);
    EXPECT_EQ(again[i].rect, images[i].rect);
    EXPECT_EQ(again[i].ray_count, images[i].ray_count);
  }
  for (const RenderCamera& frame : frames)
    EXPECT_EQ(RanksOfFirst(10, index, {frame}, {}), RanksOfFirst(10, whole, {frame}, {}));
}

TEST(Select, LfCamerasBeyondTheAngleAreLeftOut) {
  ThreadPool pool(2);
  LightField grid = Grid();
  for (uint32_t i = 0; i < grid.size(); i += 2)
    grid.cameras[i].cam_from_world.rotation =
        Eigen::AngleAxisd(RadiansFromDegrees(5), Vec3::UnitX()).toRotationMatrix();
  const std::vector<RenderCamera> frames = {Frame(0.05, 0)};
  SelectOptions options;
  const auto all = SelectImages(ImageIndex(grid), frames, options, pool);
  options.max_angle_rad = RadiansFromDegrees(4);
  const auto some = SelectImages(ImageIndex(grid), frames, options, pool);
  EXPECT_GT(all.size(), some.size());
  EXPECT_FALSE(some.empty());
  for (const SelectedImage& image : some) EXPECT_EQ(image.id.value % 2, 1U);
  TakingFrame first = {frames[0]};
  first.ranks = RanksOfFirst(5, ImageIndex(grid), first, options);
  EXPECT_EQ(SelectImages(ImageIndex(grid), {&first, 1}, options, pool).size(), 5u);
  options.max_angle_rad = RadiansFromDegrees(6);
  EXPECT_EQ(SelectImages(ImageIndex(grid), frames, options, pool).size(), all.size());
}

TEST(Select, EveryFrameTakesItsFirstImagesOnly) {
  ThreadPool pool(2);
  const LightField grid = Grid();
  std::vector<TakingFrame> frames = {{Frame(0.05, 0)}, {Frame(0.03, 0.08)}, {Frame(0.0101, 0)}};
  for (TakingFrame& frame : frames) frame.ranks = RanksOfFirst(10, ImageIndex(grid), frame, {});
  EXPECT_EQ(frames[2].ranks, RankRange{});  // this frame has only five LF images
  for (size_t f = 0; f < 2; ++f) {
    const auto all = SelectImages(ImageIndex(grid), {&frames[f].camera, 1}, {}, pool);
    const auto some = SelectImages(ImageIndex(grid), {&frames[f], 1}, {}, pool);
    ASSERT_EQ(some.size(), 10u);
    for (size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i].id, all[i].id);
    // Selecting from the end of the frame's range on returns the remaining LF images.
    const TakingFrame rest = {frames[f].camera, {frames[f].ranks.end}};
    EXPECT_EQ(SelectImages(ImageIndex(grid), {&rest, 1}, {}, pool).size(), all.size() - 10);
  }
  uint32_t taken = 0;
  for (const SelectedImage& image : SelectImages(ImageIndex(grid), frames, {}, pool))
    taken += image.frame_count;
  EXPECT_EQ(taken, 25u);
}

TEST(Select, LimitsCountAnImageOfSeveralInstantsOnce) {
  const LightField grid = Grid();
  const ImageIndex index(grid);
  const TakingFrame first = {Frame(0.05, 0)}, second = {Frame(0.05, 0.03)};
  const TakingFrame twice[] = {first, first};
  EXPECT_EQ(RanksOfFirst(5, index, twice, {}), RanksOfFirst(5, index, first, {}));
  ThreadPool pool(2);
  for (const size_t count : {1, 3, 7}) {
    TakingFrame instants[] = {first, second};
    const RankRange ranks = RanksOfFirst(count, index, instants, {});
    for (TakingFrame& instant : instants) instant.ranks = ranks;
    EXPECT_EQ(SelectImages(index, instants, {}, pool).size(), count);
  }
}

}  // namespace
}  // namespace lf
