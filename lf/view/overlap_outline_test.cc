// SPDX-License-Identifier: Apache-2.0
#include "lf/view/overlap_outline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/testing_scenes.h"
#include "lf/selection/image_index.h"
#include "lf/selection/overlap.h"
#include "lf/selection/test_rays.h"

namespace lf {
namespace {

// Returns twice the signed area; its sign is the orientation of the polygon.
double Area2(const std::vector<Vec2>& polygon) {
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool Holds(const std::vector<Vec2>& polygon, const Vec2& p, double margin_px) {
  const double sign = Area2(polygon) < 0 ? -1 : 1;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Vec2 d = b - a;
    if (d.norm() < 1e-9) continue;
    if (sign * (d.x() * (p.y() - a.y()) - d.y() * (p.x() - a.x())) < -margin_px * d.norm())
      return false;
  }
  return true;
}

// Every pixel with an accepted ray is inside an outline, and the outlines are inside the rectangle
// that selection reads.
TEST(OverlapOutlines, HoldAcceptedRaysAndFitTheirRectangle) {
  int polygons = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const auto outlines = OverlapOutlines(pair.lf_camera, pair.render_camera);
    const DistortionMap map({});
    for (int y = 0; y < pair.lf_camera.intrinsics.height_px; ++y)
      for (int x = 0; x < pair.lf_camera.intrinsics.width_px; ++x) {
        if (!testing::Contributes(pair.lf_camera, map, pair.render_camera, x, y)) continue;
        bool is_held = false;
        for (const auto& outline : outlines)
          is_held = is_held || Holds(outline, {x + 0.5, y + 0.5}, 1e-6);
        EXPECT_TRUE(is_held) << seed << ": " << x << ", " << y;
      }
    const PixelRect rect = ContributingRect(pair.lf_camera, pair.render_camera);
    for (const auto& outline : outlines) {
      ++polygons;
      for (const Vec2& corner : outline)
        if (!rect.empty()) {
          EXPECT_GE(corner.x(), rect.x_begin - 1.01) << seed;
          EXPECT_LE(corner.x(), rect.x_end + 1.01) << seed;
        }
    }
  }
  EXPECT_GT(polygons, 20);
}

TEST(OverlapOutlines, BendWithTheLens) {
  int polygons = 0;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const testing::CameraPair pair = testing::RandomDistortedPair(seed);
    for (const auto& outline : OverlapOutlines(pair.lf_camera, pair.render_camera)) {
      ++polygons;
      for (const Vec2& corner : outline) {
        EXPECT_GE(corner.x(), 0);
        EXPECT_LE(corner.y(), pair.lf_camera.intrinsics.height_px);
      }
    }
  }
  EXPECT_GT(polygons, 5);
}

}  // namespace
}  // namespace lf
