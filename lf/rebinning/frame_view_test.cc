// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/frame_view.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

// FindSeenCells() finds the same cells as RayView, at the same positions. The cells lie on all
// sides of the frame, which looks about along the normals of the slab's planes or aside.
TEST(FrameView, SeesWhatSingleRaysSee) {
  Slab slab;
  slab.st = {Vec3(0.01, 0, 0.002), Vec3(0.8, 0.6, 0), Vec3(-0.6, 0.8, 0)};
  slab.uv = {Vec3(0, 0, 1), Vec3(0.8, 0, 0.6), Vec3(0, 1, 0)};
  slab.r_st_w = 0.0003;
  slab.r_uv_w = 0.0011;
  RandomSequence random(1);
  size_t seen_count = 0, unseen_count = 0;
  for (const double tilt : {0.0, 0.7})
    for (const double aside : {0.0, 0.4, 3.0}) {
      RenderCamera frame;
      frame.pinhole.intrinsics = {400, 390, 160, 125, 3, 320, 240};
      frame.pinhole.cam_from_world =
          *LookAlong(Vec3(0.01, -0.02, -0.01), Vec3(aside, 0.02, 1 - aside), -Vec3::UnitY());
      frame.aperture.radius_w = 0.04;
      frame.focus_plane = FocusPlane(frame.pinhole, 1.3, {tilt, 0.1});
      const FrameReach reach{0.002, 3};
      const FrameView view(slab, frame, reach);
      const RayView judge(frame, reach);
      std::vector<BinnedCell> cells(50000);
      const auto number = [&](double reach_w, double r_w) {
        return static_cast<CellKey>(kCellOffset + random.Uniform(-reach_w, reach_w) / r_w);
      };
      for (BinnedCell& cell : cells)
        cell.cell = number(0.06, slab.r_st_w) | number(0.06, slab.r_st_w) << 16 |
                    number(1, slab.r_uv_w) << 32 | number(1, slab.r_uv_w) << 48;
      SeenCells seen;
      for (size_t begin = 0; begin < cells.size(); begin += 63) {
        const auto some =
            std::span(cells).subspan(begin).first(std::min<size_t>(63, cells.size() - begin));
        FindSeenCells(view, some, &seen);
        size_t next = 0;
        for (size_t i = 0; i < some.size(); ++i) {
          const bool is_seen = next < seen.count && seen.cells[next] == i;
          const auto expected = judge.See(RayOfPoint(slab, MiddleOf(slab, some[i].cell)));
          ASSERT_EQ(is_seen, expected.has_value());
          (is_seen ? seen_count : unseen_count) += 1;
          if (!is_seen) continue;
          EXPECT_NEAR(seen.lens_x_w[next], expected->lens_x_w, 1e-8);
          EXPECT_NEAR(seen.lens_y_w[next], expected->lens_y_w, 1e-8);
          EXPECT_NEAR(seen.x_px[next], expected->x_px, 1e-4);
          EXPECT_NEAR(seen.y_px[next], expected->y_px, 1e-4);
          ++next;
        }
        EXPECT_EQ(next, seen.count);
      }
    }
  EXPECT_GT(seen_count, 10000u);
  EXPECT_GT(unseen_count, 100000u);
}

}  // namespace
}  // namespace lf
