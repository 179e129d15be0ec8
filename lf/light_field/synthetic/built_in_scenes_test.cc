// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/built_in_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/light_field/synthetic/photograph.h"

namespace lf {
namespace {

// Returns the cameras of the recommended capture.
std::vector<PinholeCamera> Cameras(const BuiltInScene& scene) {
  const std::vector<RigidTransform> poses = *MakeRig(scene.rig);
  std::vector<PinholeCamera> cameras;
  cameras.reserve(poses.size());
  for (const RigidTransform& pose : poses)
    cameras.push_back({IntrinsicsFor(scene, scene.width_px, scene.height_px), pose});
  return cameras;
}

TEST(BuiltInScenes, EachIsFoundByItsName) {
  ASSERT_EQ(BuiltInScenes().size(), 4U);
  for (const BuiltInScene& scene : BuiltInScenes()) EXPECT_EQ(FindBuiltInScene(scene.name), &scene);
  EXPECT_EQ(FindBuiltInScene("still life"), nullptr);
}

TEST(BuiltInScenes, PicturesAreFiniteNeverNegativeAndWithinTheirMaximum) {
  for (const BuiltInScene& scene : BuiltInScenes()) {
    PinholeCamera camera = Cameras(scene).front();
    camera.intrinsics = IntrinsicsFor(scene, 120, 80);
    const Image<float> picture = Photograph(Scene(scene.describe()), camera, 4);
    double brightest = 0;
    for (const float value : picture.pixels()) {
      ASSERT_TRUE(std::isfinite(value));
      ASSERT_GE(value, 0.0F);
      brightest = std::max(brightest, static_cast<double>(value));
    }
    EXPECT_LE(brightest, scene.max_radiance);
    EXPECT_GT(brightest, 0.5);
  }
}

// Checks that 2 exp(-2 (pi sigma / step)^2) is below 2 % for all lamps, at all focus distances for
// which the captures are meant.
TEST(BuiltInScenes, TheRecommendedCapturesShowBokehWithoutDots) {
  for (const BuiltInScene& scene : BuiltInScenes()) {
    const std::vector<PinholeCamera> cameras = Cameras(scene);
    const PinholeCamera& middle = cameras[cameras.size() / 2];
    const double focal_px = middle.intrinsics.fx_px;
    for (const Glow& glow : scene.describe().glows) {
      const double depth_w = (middle.cam_from_world * glow.centre_world).z();
      const double sigma_px = focal_px * glow.radius_w / (std::sqrt(2.0) * depth_w);
      for (const double focus_w : {0.55, 0.8, 1.2, 3.0}) {
        const double step_px = focal_px * scene.rig.spacing_w * std::abs(1 / focus_w - 1 / depth_w);
        EXPECT_LT(2 * std::exp(-2 * std::pow(kPi * sigma_px / step_px, 2)), 0.02)
            << scene.name << ": depth " << depth_w << ", focus " << focus_w;
      }
    }
  }
}

TEST(BuiltInScenes, TheMiddleCameraStandsAtTheDepthsTheManualSays) {
  const BuiltInScene& still_life = *FindBuiltInScene("still-life");
  const std::vector<PinholeCamera> cameras = Cameras(still_life);
  ASSERT_EQ(cameras.size(), 289U);
  const SceneDescription scene = still_life.describe();
  for (const Sphere& sphere : scene.spheres) {
    const double depth_w = (cameras[144].cam_from_world * sphere.centre_world).z();
    EXPECT_GT(depth_w, 0.40);
    EXPECT_LT(depth_w, 1.35);
  }
  for (const Glow& glow : scene.glows) {
    const double depth_w = (cameras[144].cam_from_world * glow.centre_world).z();
    EXPECT_GT(depth_w, 2.0);
    EXPECT_LT(depth_w, 2.8);
  }
  // No two spheres overlap.
  for (size_t i = 0; i < scene.spheres.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_GE((scene.spheres[i].centre_world - scene.spheres[j].centre_world).norm(),
                scene.spheres[i].radius_w + scene.spheres[j].radius_w);
}

TEST(BuiltInScenes, ChartsStandAtTheirDepths) {
  const BuiltInScene& chart = *FindBuiltInScene("chart");
  const Vec3 camera_world = Cameras(chart)[144].CentreWorld();
  const std::vector<Panel> panels = chart.describe().panels;
  ASSERT_EQ(panels.size(), 5U);
  EXPECT_NEAR(panels[0].centre_world.z() - camera_world.z(), 1.0, 1e-9);  // star
  EXPECT_NEAR(panels[1].centre_world.z() - camera_world.z(), 0.7, 1e-9);  // digits
  EXPECT_NEAR(panels[2].centre_world.z() - camera_world.z(), 1.4, 1e-9);
  const auto reach_w = [](const Panel& panel) {
    return std::abs(panel.half_right_w.z()) + std::abs(panel.half_up_w.z());
  };
  EXPECT_NEAR(reach_w(panels[3]), 0.2, 1e-9);  // bars, 0.8 to 1.2
  EXPECT_NEAR(reach_w(panels[4]), 0.4, 1e-9);  // the board, 0.6 to 1.4
}

}  // namespace
}  // namespace lf
