// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/ray_forms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/testing_scenes.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// Compares every form with the geometry that it stands for, ray by ray.
TEST(RayForms, AgreeWithTheGeometry) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const RenderCamera& render = pair.render_camera;
    const RayForms forms = MakeRayForms(pair.lf_camera, render);
    const Vec3 c_lens = render.pinhole.CentreWorld();
    const Vec3 f = render.pinhole.ForwardWorld();
    for (uint64_t i = 0; i < 20; ++i) {
      const double px = 50 * RandomUnit(seed, 1, i), py = 35 * RandomUnit(seed, 2, i);
      const auto at = [&](const PixelForm& form) { return Value(form, px, py); };
      const Ray ray = RayOfPixel(pair.lf_camera, px, py);
      EXPECT_NEAR(at(forms.forward), f.dot(ray.direction), 1e-12);
      EXPECT_NEAR(at(forms.plane), render.focus_plane.normal.dot(ray.direction), 1e-12);
      const Vec3 x = *IntersectLine(ray, render.focus_plane);
      EXPECT_NEAR(at(forms.front) / at(forms.plane), f.dot(x - c_lens), 1e-9 * (1 + x.norm()));
      if (const auto element = Project(render.pinhole, x)) {
        EXPECT_NEAR(at(forms.sensor_x) / at(forms.front), element->x(),
                    1e-9 * (1e3 + std::abs(element->x())));
        EXPECT_NEAR(at(forms.sensor_y) / at(forms.front), element->y(),
                    1e-9 * (1e3 + std::abs(element->y())));
      }
      const Vec3 on_lens = *IntersectLine(ray, {f, f.dot(c_lens)}) - c_lens;
      EXPECT_NEAR(at(forms.lens_right) / at(forms.forward),
                  on_lens.dot(render.pinhole.RightWorld()), 1e-9 * (1 + on_lens.norm()));
      EXPECT_NEAR(at(forms.lens_up) / at(forms.forward), on_lens.dot(render.pinhole.UpWorld()),
                  1e-9 * (1 + on_lens.norm()));
    }
  }
}

TEST(HalfPlanes, HoldEveryRayThatReachesThePlate) {
  size_t reached_count = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const testing::CameraPair pair = testing::RandomCameraPair(seed);
    const RenderCamera& render = pair.render_camera;
    const RayForms forms = MakeRayForms(pair.lf_camera, render);
    const std::vector<PixelForm> lens = LensHalfPlanes(forms, render, 1e-6);
    const std::array<PixelForm, kPlateHalfPlanes> sides[2] = {
        PlateHalfPlanes(forms, render, -1, 1e-6), PlateHalfPlanes(forms, render, +1, 1e-6)};
    const Vec3 c_lens = render.pinhole.CentreWorld();
    const Vec3 f = render.pinhole.ForwardWorld();
    for (int y = 0; y < 35; ++y)
      for (int x = 0; x < 50; ++x) {
        const Ray ray = RayOfPixel(pair.lf_camera, x + 0.5, y + 0.5);
        if (f.dot(ray.direction) <= 0) continue;
        const Vec3 on_lens = *IntersectLine(ray, {f, f.dot(c_lens)}) - c_lens;
        if (!Contains(render.aperture, {on_lens.dot(render.pinhole.RightWorld()),
                                        on_lens.dot(render.pinhole.UpWorld())}))
          continue;
        const auto element = Project(render.pinhole, *IntersectLine(ray, render.focus_plane));
        if (!element || element->x() < 0 || element->x() >= 160 || element->y() < 0 ||
            element->y() >= 120)
          continue;
        ++reached_count;
        const bool positive = render.focus_plane.normal.dot(ray.direction) > 0;
        for (const PixelForm& form : lens) EXPECT_LE(Value(form, x + 0.5, y + 0.5), 0) << seed;
        for (const PixelForm& form : sides[positive])
          EXPECT_LE(Value(form, x + 0.5, y + 0.5), 0) << seed;
      }
  }
  EXPECT_GT(reached_count, 1000u);  // the scenes are not empty
}

}  // namespace
}  // namespace lf
