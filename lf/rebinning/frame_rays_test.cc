// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/frame_rays.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

// Returns a camera 0.01 world units behind the st plane that looks a little aside. Its focus plane
// is tilted.
RenderCamera TestFrame(double horizontal_rad) {
  RenderCamera frame;
  frame.pinhole.intrinsics = {400, 400, 160, 120, 0, 320, 240};
  frame.pinhole.cam_from_world =
      *LookAlong(Vec3(0.01, -0.02, -0.01), Vec3(0.05, 0.02, 1), -Vec3::UnitY());
  frame.aperture.radius_w = 0.02;
  frame.focus_plane = FocusPlane(frame.pinhole, 1.3, {horizontal_rad, 0.1});
  return frame;
}

TEST(FrameRays, GoFromTheLensThroughTheFocusPlaneToTheirElement) {
  Slab slab;
  slab.uv.origin_world = Vec3(0, 0, 1);
  slab.r_st_w = 0.0003;
  slab.r_uv_w = 0.0011;
  ThreadPool pool(2);
  for (const double tilt : {0.0, 0.7}) {
    const RenderCamera frame = TestFrame(tilt);
    std::vector<BinnedCell> cells;
    std::vector<std::array<double, 4>> expected;
    RandomSequence random(1);
    const FrameReach reach{0.002, 3};
    for (int i = 0; i < 3000; ++i) {
      const double x = random.Uniform(-8, 328), y = random.Uniform(-8, 248);
      const Vec2 on_lens(random.Uniform(-0.024, 0.024), random.Uniform(-0.024, 0.024));
      const auto focus = FocusPointOfElement(frame, x, y);
      ASSERT_TRUE(focus);
      const Vec3 lens_point = LensPointWorld(frame, on_lens);
      const auto point = Parameterize(slab, {lens_point, *focus - lens_point});
      ASSERT_TRUE(point);
      BinnedCell cell;
      cell.cell = *CellOf(slab, *point);
      cell.Add({cell.cell, {static_cast<uint16_t>(i), 7, 9}});
      cells.push_back(cell);
      expected.push_back({x, y, on_lens.x(), on_lens.y()});
    }
    const LargeVector<FrameRay> rays = FrameRaysOf(slab, cells, frame, reach, pool);
    EXPECT_GT(rays.size(), 1800u);
    size_t next = 0;
    for (const FrameRay& ray : rays) {
      const auto i = static_cast<size_t>(ray.rgb[0]);
      ASSERT_GE(i, next);
      // Rays that are left out are beyond the reach. These bounds are relaxed by the largest
      // distance between a ray and the middle ray of its cell.
      for (; next < i; ++next) {
        const auto& [x, y, lens_x, lens_y] = expected[next];
        EXPECT_TRUE(x < -2 || x > 322 || y < -2 || y > 242 ||
                    std::hypot(lens_x, lens_y) > 0.022 - 0.0005);
      }
      next = i + 1;
      EXPECT_NEAR(ray.x_px, expected[i][0], 1.2);
      EXPECT_NEAR(ray.y_px, expected[i][1], 1.2);
      EXPECT_NEAR(ray.lens_x_w, expected[i][2], 0.0005);
      EXPECT_NEAR(ray.lens_y_w, expected[i][3], 0.0005);
      EXPECT_EQ(ray.rgb[2], 9);
    }
  }
}

// A ray that meets the uv plane at some point gets the same position on the plate as the query from
// the lens point to this point, although the frame's focus is elsewhere.
TEST(FrameRays, ThroughALensPointAreToldApartOnTheSlab) {
  Slab slab;
  slab.uv.origin_world = Vec3(0, 0, 3);
  slab.r_st_w = 1e-5;
  slab.r_uv_w = 1e-4;
  ThreadPool pool(1);
  RenderCamera frame;
  frame.pinhole.intrinsics = {300, 300, 160, 120, 0, 320, 240};
  frame.aperture = {0.02, 0, 0};
  frame.focus_plane = FocusPlane(frame.pinhole, 1.5, {});
  const Vec2 lens_point(0.01, -0.005);
  RandomSequence random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 on_uv(random.Uniform(-1, 1), random.Uniform(-1, 1), 3);
    const Vec2 beside(random.Uniform(-0.003, 0.003), random.Uniform(-0.003, 0.003));
    // Lens coordinates run right and up, slab coordinates right and down.
    const Vec3 on_st(lens_point.x() + beside.x(), -lens_point.y() + beside.y(), 0);
    BinnedCell cell;
    cell.cell = *CellOf(slab, *Parameterize(slab, {on_st, on_uv - on_st}));
    cell.Add({cell.cell, {1, 2, 3}});
    const LargeVector<FrameRay> rays =
        FrameRaysThrough(lens_point, slab, std::span(&cell, 1), frame, {0.01, 0}, pool);
    const Vec3 lens_world = LensPointWorld(frame, lens_point);
    const Vec3 focus = lens_world + 0.5 * (on_uv - lens_world);
    const auto seen = Project(frame.pinhole, focus);
    if (std::abs(seen->x() - 160) > 159 || std::abs(seen->y() - 120) > 119) continue;
    ASSERT_EQ(rays.size(), 1u);
    EXPECT_NEAR(rays[0].x_px, seen->x(), 0.05);
    EXPECT_NEAR(rays[0].y_px, seen->y(), 0.05);
    EXPECT_NEAR(std::hypot(rays[0].lens_x_w - lens_point.x(), rays[0].lens_y_w - lens_point.y()),
                beside.norm(), 2e-5);
    EXPECT_TRUE(FrameRaysThrough(lens_point, slab, std::span(&cell, 1), frame,
                                 {0.9 * beside.norm(), 0}, pool)
                    .empty());
  }
}

}  // namespace
}  // namespace lf
