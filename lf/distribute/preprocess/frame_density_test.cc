// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/frame_density.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

// Returns a grid of 41 x 41 LF cameras with pitch 0.01 in the plane z = 0.
LightField Grid() {
  LightField field;
  field.intrinsics = {{200, 200, 100, 75, 0, 200, 150}};
  for (int row = -20; row <= 20; ++row)
    for (int column = -20; column <= 20; ++column) {
      LfCamera camera;
      camera.cam_from_world.translation = {-0.01 * column, -0.01 * row, 0};
      field.cameras.push_back(camera);
      field.image_names.push_back("x.png");
    }
  return field;
}

RenderCamera Frame(double radius_w, double x, double y, double z) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {400, 400, 80, 60, 0, 160, 120};
  frame.pinhole.cam_from_world.translation = {-x, -y, -z};
  frame.aperture = {radius_w, 0, 0};
  frame.focus_distance_w = 2;
  frame.focus_plane = FocusPlane(frame.pinhole, 2, {});
  return frame;
}

TEST(FrameDensity, OfAGridInTheLensPlane) {
  const LightField grid = Grid();
  const ImageIndex index(grid);
  const FrameDensity density = DensityOf(index, Frame(0.0301, 0, 0, 0), DepthRange{1, 4});
  EXPECT_EQ(density.cameras_in_lens, 29u);  // integer points within radius 3
  EXPECT_NEAR(density.camera_distance_w, 0.01, 0.001);
  EXPECT_LT(density.coverage.uncovered_share, 0.01);
  EXPECT_EQ(density.least_aperture_w, 0);  // one LF camera is at the lens centre
  EXPECT_NEAR(density.near_displacement_px, 400 * density.camera_distance_w * 0.5, 1e-9);
  EXPECT_NEAR(density.far_displacement_px, 400 * density.camera_distance_w * 0.25, 1e-9);
  EXPECT_EQ(density.DepthOfMost_w(), 1);
  // The lens is in the middle of four LF cameras: the nearest one is half a diagonal away.
  EXPECT_NEAR(DensityOf(index, Frame(0.03, 0.005, 0.005, 0), {}).least_aperture_w,
              0.01 * std::sqrt(2), 1e-9);
}

// Virtual LF cameras between those of the grid make no capture denser.
TEST(FrameDensity, CountsRecordedCamerasAlone) {
  LightField grid = Grid();
  const RenderCamera frame = Frame(0.0301, 0, 0, 0);
  const FrameDensity recorded = DensityOf(ImageIndex(grid), frame, DepthRange{1, 4});
  for (int row = -20; row < 20; ++row)
    for (int column = -20; column < 20; ++column) {
      LfCamera& camera = grid.cameras.emplace_back();
      camera.cam_from_world.translation = {-0.01 * column - 0.005, -0.01 * row - 0.005, 0};
      camera.is_virtual = true;
      grid.image_names.push_back("virtual/x");
    }
  const FrameDensity densified = DensityOf(ImageIndex(grid), frame, DepthRange{1, 4});
  EXPECT_EQ(densified.cameras_in_lens, recorded.cameras_in_lens);
  EXPECT_EQ(densified.camera_distance_w, recorded.camera_distance_w);
  EXPECT_EQ(densified.MostDisplacement_px(), recorded.MostDisplacement_px());
  EXPECT_EQ(densified.least_aperture_w, recorded.least_aperture_w);
  for (LfCamera& camera : grid.cameras) camera.is_virtual = false;
  EXPECT_GT(DensityOf(ImageIndex(grid), frame, DepthRange{1, 4}).cameras_in_lens,
            recorded.cameras_in_lens);
}

TEST(WantsVirtual, IfCopiesAreSeenAndThereAreNoVirtualLfImages) {
  FrameDensity density;
  density.near_displacement_px = 1.9;
  density.far_displacement_px = 1;
  EXPECT_FALSE(WantsVirtual(density, false));
  density.far_displacement_px = 2.1;
  EXPECT_TRUE(WantsVirtual(density, false));
  EXPECT_FALSE(WantsVirtual(density, true));
}

TEST(FrameDensity, OfAFrameBeforeTheGrid) {
  const LightField grid = Grid();
  const ImageIndex index(grid);
  // The frame is half-way between the grid and the focus plane: in its lens plane, rays are half as
  // far apart as the LF cameras. A point at depth 1 from the grid is at depth 0 from the frame,
  // which is limited to 0.1.
  RenderCamera frame = Frame(0.0301, 0, 0, 1);
  frame.focus_distance_w = 1;
  frame.focus_plane = FocusPlane(frame.pinhole, 1, {});
  const FrameDensity density = DensityOf(index, frame, DepthRange{1, 4});
  EXPECT_NEAR(density.camera_distance_w, 0.005, 0.0005);
  EXPECT_NEAR(density.depths.near_w, 0.1, 1e-12);
  EXPECT_NEAR(density.depths.far_w, 3, 1e-9);
}

TEST(FrameDensity, BesideTheCaptureTheLensIsUncovered) {
  const LightField grid = Grid();
  const ImageIndex index(grid);
  EXPECT_NEAR(DensityOf(index, Frame(0.1, 0.22, 0, 0), {}).coverage.uncovered_share, 0.6, 0.05);
}

TEST(FrameDensity, WithoutDepthsAQuarterBeforeAndBehindTheFocusIsAsked) {
  const LightField grid = Grid();
  const FrameDensity density = DensityOf(ImageIndex(grid), Frame(0.03, 0, 0, 0), {});
  EXPECT_EQ(density.depths, (DepthRange{1.5, 2.5}));
}

}  // namespace
}  // namespace lf
