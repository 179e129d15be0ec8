// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/overlap.h"

#include <gtest/gtest.h>

#include <tuple>

#include "lf/camera/ray.h"
#include "lf/camera/testing_scenes.h"
#include "lf/selection/seen_region.h"
#include "lf/selection/test_rays.h"

namespace lf {
namespace {

using testing::Contributes;

TEST(Overlap, NoContributingRayLiesOutsideTheRectangle) {
  size_t contributing_images = 0, selected_images = 0, rays = 0, pixels = 0;
  size_t idle_images = 0, plainly_idle_images = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const PixelRect rect = ContributingRect(pair.lf_camera, pair.render_camera);
    const DistortionMap map({});
    bool any = false;
    for (int y = 0; y < 35; ++y)
      for (int x = 0; x < 50; ++x)
        if (Contributes(pair.lf_camera, map, pair.render_camera, x, y)) {
          any = true;
          ++rays;
          ASSERT_TRUE(rect.Contains(x, y)) << seed << ": " << x << ", " << y;
        }
    contributing_images += any;
    selected_images += !rect.empty();
    pixels += static_cast<size_t>(rect.pixel_count());
    idle_images += !any;
    plainly_idle_images +=
        ImageOverlap(pair.lf_camera, {}, PixelReach::kOwn).PlainlyMisses(pair.render_camera);
  }
  EXPECT_GT(contributing_images, 1000u);
  EXPECT_GT(plainly_idle_images, idle_images / 2);
  // Few LF images are selected in vain, and the rectangles have at most twice as many pixels as
  // contributing rays.
  EXPECT_LE(selected_images, contributing_images + contributing_images * 3 / 100);
  EXPECT_LE(pixels, 2 * rays);
}

// Returns true if a piece of the frame's focal surface accepts the ray of a pixel.
bool ContributesToPiece(const PinholeCamera& lf_camera, const DistortionMap& map,
                        const RenderCamera& frame, int x, int y) {
  bool any = false;
  ForEachPiece(frame, [&](const RenderCamera& piece) {
    if (any || !Contributes(lf_camera, map, piece, x, y)) return;
    const Ray ray{lf_camera.CentreWorld(),
                  lf_camera.cam_from_world.rotation.transpose() *
                      (lf_camera.intrinsics.InverseMatrix() *
                       *IdealPosition(lf_camera.intrinsics, map, x + 0.5, y + 0.5))};
    const Vec2 element = *Project(piece.pinhole, *IntersectLine(ray, piece.focus_plane));
    any = piece.window->Contains(static_cast<int>(element.x()), static_cast<int>(element.y()));
  });
  return any;
}

TEST(Overlap, NoRayOfAFocalSurfaceLiesOutsideTheRectangleOrTheSeenRegion) {
  size_t rays = 0, pixels = 0, images = 0;
  for (uint64_t seed = 0; seed < 600; ++seed) {
    testing::CameraPair pair =
        seed % 4 == 0 ? testing::RandomDistortedPair(seed / 4) : testing::RandomCameraPair(seed);
    if (!testing::SetRandomSurface(40, 0.4, seed, &pair.render_camera)) continue;
    const Intrinsics& k = pair.lf_camera.intrinsics;
    std::vector<IdealCell> cells;
    if (k.has_distortion()) cells = MakeIdealCells(k);
    const PixelRect rect = ContributingRect(pair.lf_camera, pair.render_camera, cells);
    const SeenRegion region(pair.render_camera);
    const DistortionMap map(k.distortion);
    const int step = k.has_distortion() ? 7 : 1;
    bool any = false;
    for (int y = static_cast<int>(seed) % step; y < k.height_px; y += step)
      for (int x = static_cast<int>(seed / 7) % step; x < k.width_px; x += step)
        if (ContributesToPiece(pair.lf_camera, map, pair.render_camera, x, y)) {
          any = true;
          rays += static_cast<size_t>(step) * static_cast<size_t>(step);
          ASSERT_TRUE(rect.Contains(x, y)) << seed << ": " << x << ", " << y;
        }
    EXPECT_FALSE(any && region.Misses(pair.lf_camera.CentreWorld())) << seed;
    images += any;
    pixels += static_cast<size_t>(rect.pixel_count());
  }
  EXPECT_GT(images, 100u);
  EXPECT_LE(pixels, 4 * rays);
}

TEST(Overlap, NoContributingRayOfADistortedImageLiesOutsideTheRectangle) {
  size_t contributing_images = 0, selected_images = 0, rays = 0, pixels = 0;
  for (uint64_t seed = 0; seed < 350; ++seed) {
    const testing::CameraPair pair = testing::RandomDistortedPair(seed);
    const std::vector<IdealCell> cells = MakeIdealCells(pair.lf_camera.intrinsics);
    const PixelRect rect = ContributingRect(pair.lf_camera, pair.render_camera, cells);
    const DistortionMap map(pair.lf_camera.intrinsics.distortion);
    bool any = false;
    // Tests every third pixel. The offset depends on the seed, so that pixels next to the
    // rectangles are tested for some seeds.
    for (int y = static_cast<int>(seed % 3); y < 140; y += 3)
      for (int x = static_cast<int>(seed / 3 % 3); x < 200; x += 3)
        if (Contributes(pair.lf_camera, map, pair.render_camera, x, y)) {
          any = true;
          rays += 9;
          ASSERT_TRUE(rect.Contains(x, y)) << seed << ": " << x << ", " << y;
        }
    contributing_images += any;
    selected_images += !rect.empty();
    pixels += static_cast<size_t>(rect.pixel_count());
  }
  EXPECT_GT(contributing_images, 120u);
  EXPECT_LE(selected_images, contributing_images + contributing_images * 3 / 10);
  EXPECT_LE(pixels, 4 * rays);
}

TEST(Overlap, CamerasExactlyOnTheRimAreSelected) {
  const PixelRect whole{0, 0, 50, 35};
  for (const auto& [column, row] : {std::pair{3, 4}, {5, 0}, {0, -5}, {-4, 3}}) {
    const testing::CameraPair on_rim = testing::ParallelPair(column, row, 0.01, 0.05);
    EXPECT_GT(ContributingRect(on_rim.lf_camera, on_rim.render_camera).pixel_count(), 1000);
  }
  const testing::CameraPair centre = testing::ParallelPair(0, 0, 0.01, 0.05);
  EXPECT_EQ(ContributingRect(centre.lf_camera, centre.render_camera), whole);
}

TEST(Overlap, LensOutsideTheImageGivesNoPixels) {
  const testing::CameraPair far_away = testing::ParallelPair(30, 0, 0.01, 0.05);
  EXPECT_TRUE(ContributingRect(far_away.lf_camera, far_away.render_camera).empty());
}

TEST(Overlap, ImagesLookingTheOtherWayGiveNoPixels) {
  testing::CameraPair pair = testing::ParallelPair(0, 0, 0.01, 0.05);
  pair.lf_camera.cam_from_world = *LookAlong({0, 0, 1}, {0, 0, -1}, {0, -1, 0});
  EXPECT_TRUE(ContributingRect(pair.lf_camera, pair.render_camera).empty());
}

TEST(Overlap, CamerasBeyondTheRimPlainlyMiss) {
  // The rim of the lens is at 5 pitches, and the vertices of its circumscribed 16-gon are at 5.098
  // pitches.
  for (const auto& [column, row, misses] :
       {std::tuple{5, 0, false}, {0, -5, false}, {4, 3, false}, {3, 5, true}, {-6, 0, true}}) {
    const testing::CameraPair pair = testing::ParallelPair(column, row, 0.01, 0.05);
    const ImageOverlap overlap(pair.lf_camera, {}, PixelReach::kOwn);
    EXPECT_EQ(overlap.PlainlyMisses(pair.render_camera), misses) << column << ", " << row;
    EXPECT_EQ(overlap.Rect(pair.render_camera).empty(), misses) << column << ", " << row;
  }
}

TEST(Overlap, TheCorrectionOfMosaicsReadsTwoPixelsMore) {
  testing::CameraPair pair = testing::ParallelPair(1, 0, 0.01, 0.05);
  // A frame that shows the middle of the LF image.
  pair.render_camera.pinhole.intrinsics.fx_px *= 3;
  pair.render_camera.pinhole.intrinsics.fy_px *= 3;
  const PixelRect element =
      ContributingRect(pair.lf_camera, pair.render_camera, {}, PixelReach::kElement);
  EXPECT_GT(element.x_begin, 2);
  const PixelRect wider{element.x_begin - 2, element.y_begin - 2, element.x_end + 2,
                        element.y_end + 2};
  EXPECT_EQ(ContributingRect(pair.lf_camera, pair.render_camera, {}, PixelReach::kCorrectedElement),
            wider);
}

TEST(Overlap, ALensBehindTheBackOfTheCameraStillCounts) {
  testing::CameraPair pair = testing::ParallelPair(0, 0, 0.01, 0.2);
  // The LF camera is 1 world unit in front of the lens and looks away from it.
  pair.lf_camera.cam_from_world.translation = {0, 0, -1};
  const PixelRect rect = ContributingRect(pair.lf_camera, pair.render_camera);
  EXPECT_EQ(rect.width(), 40);  // slopes up to 0.2 to both sides, focal length 100 pixels
}

TEST(Overlap, ACameraInTheFocusPlaneContributes) {
  testing::CameraPair pair = testing::ParallelPair(0, 0, 0.01, 9);
  pair.lf_camera.cam_from_world.translation = {0.1, 0.05, -2};
  EXPECT_EQ(ContributingRect(pair.lf_camera, pair.render_camera), (PixelRect{0, 0, 50, 35}));
}

}  // namespace
}  // namespace lf
