// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/photograph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/light_field/synthetic/built_in_scenes.h"

namespace lf {
namespace {

PinholeCamera Camera(int width, int height, double focal_px) {
  PinholeCamera camera;
  camera.intrinsics = {focal_px, focal_px, width / 2.0, height / 2.0, 0, width, height};
  return camera;  // at the origin, looking along +z
}

// Returns a white ball in white ambient light in front of a black background, so that the value of
// a pixel is the share of it that the ball covers.
Scene WhiteBall(const Vec3& centre, double radius_w) {
  SceneDescription description;
  Material white;
  white.colour = Rgb::Ones();
  description.materials = {white};
  description.spheres = {{centre, radius_w, 0}};
  description.room.ambient = Rgb::Ones();
  return Scene(description);
}

// The cone that touches a ball of radius R at distance d has a half angle of asin(R / d).
TEST(Photograph, ABallOnTheAxisCoversACircle) {
  const Image<float> picture = Photograph(WhiteBall({0, 0, 4}, 1), Camera(120, 120, 200), 16);
  const double radius_px = 200 * std::tan(std::asin(0.25));
  double area = 0;
  for (size_t i = 0; i < picture.pixels().size(); i += 3)
    area += static_cast<double>(picture.pixels()[i]);
  EXPECT_NEAR(area, kPi * radius_px * radius_px, 0.002 * area);
}

TEST(Photograph, ABallBesideTheAxisIsStretchedOutwards) {
  const double away = 0.5, half = std::asin(0.2);  // angles
  const Vec3 centre = 5 * Vec3(std::sin(away), 0, std::cos(away));
  const Image<float> picture = Photograph(WhiteBall(centre, 1), Camera(400, 101, 200), 25);
  double width = 0, moment = 0;
  for (int x = 0; x < 400; ++x) {
    width += static_cast<double>(picture.at(x, 50));
    moment += (x + 0.5) * static_cast<double>(picture.at(x, 50));
  }
  const double right = 200 * std::tan(away + half), left = 200 * std::tan(away - half);
  EXPECT_NEAR(width, right - left, 0.2);
  EXPECT_NEAR(moment / width, 200 + 0.5 * (left + right), 0.2);
}

TEST(Photograph, WhereNothingChangesAPixelIsTheRayThroughItsCentre) {
  const Scene scene = WhiteBall({0.3, 0, 4}, 1);
  const PinholeCamera camera = Camera(60, 40, 100);
  const Image<float> one = Photograph(scene, camera, 1), many = Photograph(scene, camera, 9);
  int changed = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      const Rgb radiance = scene.RadianceAlong(RayOfPixel(camera, x + 0.5, y + 0.5));
      EXPECT_NEAR(static_cast<double>(one.at(x, y, 1)), radiance[1], 1e-6);
      changed += one.at(x, y, 1) != many.at(x, y, 1);
    }
  EXPECT_GT(changed, 60);   // the outline
  EXPECT_LT(changed, 600);  // nothing else may change
}

// Photograph() finds for each tile the shapes that its rays may hit. It must not miss any shape.
TEST(Photograph, EveryPixelIsWhatItsRayAloneSees) {
  const BuiltInScene& still_life = *FindBuiltInScene("still-life");
  const Scene scene(still_life.describe());
  const PinholeCamera camera{IntrinsicsFor(still_life, 150, 100), MakeRig(still_life.rig)->front()};
  const Image<float> picture = Photograph(scene, camera, 1);
  const Footprint footprint = FootprintOfPixel(1 / camera.intrinsics.fx_px);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 150; ++x) {
      const Rgb seen = scene.RadianceAlong(RayOfPixel(camera, x + 0.5, y + 0.5), footprint);
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(static_cast<double>(picture.at(x, y, channel)), seen[channel],
                    1e-5 * (1 + seen[channel]));
    }
}

RenderCamera Lens(const PinholeCamera& pinhole, double radius_w, int blades, double focus_w) {
  RenderCamera camera;
  camera.pinhole = pinhole;
  camera.aperture = {radius_w, blades, 0};
  camera.focus_distance_w = focus_w;
  camera.focus_plane = FocusPlane(pinhole, focus_w, {});
  return camera;
}

Scene OneGlow(const Vec3& place) {
  SceneDescription description;
  description.glows = {{place, 0.002, Rgb::Constant(100)}};
  return Scene(description);
}

// The image of a glow out of focus has the shape of the lens, with a radius of f r |1/g - 1/z|
// elements. It is upright for glows beyond the focus plane, and upside down for glows in front of
// it.
TEST(Photograph, OutOfFocusAGlowTakesTheShapeOfTheLens) {
  ThreadPool pool(2);
  for (const double depth_w : {2.0, 0.6}) {
    const RenderCamera camera = Lens(Camera(81, 81, 400), 0.05, 5, 1);
    const Image<float> picture =
        ThinLensPhotograph(OneGlow({0, 0, depth_w}), camera, {529, 0}, pool);
    const double radius_px = 400 * 0.05 * std::abs(1 - 1 / depth_w);
    const double up = depth_w > 1 ? -1 : 1;  // image rows run downwards
    const auto at = [&](double dx, double dy) {
      return static_cast<double>(picture.at(static_cast<int>(40.5 + radius_px * dx),
                                            static_cast<int>(40.5 + radius_px * dy * up)));
    };
    const double middle = at(0, 0);
    EXPECT_GT(middle, 0.01);
    EXPECT_GT(at(0, 0.75), 0.6 * middle);  // towards the vertex
    EXPECT_LT(at(0, 1.3), 0.02 * middle);
    EXPECT_LT(at(0, -1.1), 0.1 * middle);  // beyond the opposite edge, at cos(36 degrees)
    double sum = 0, row = 0;
    for (int y = 0; y < 81; ++y)
      for (int x = 0; x < 81; ++x) {
        sum += static_cast<double>(picture.at(x, y));
        row += (y + 0.5) * static_cast<double>(picture.at(x, y));
      }
    EXPECT_NEAR(row / sum, 40.5, 0.1);  // the pentagon's centre of mass is the centre of the lens
    // No light is lost: the glow's image has the same flux as in focus.
    const double radius_in_focus_px = 400 * 0.002 / depth_w;
    EXPECT_NEAR(sum, 100 * kPi * radius_in_focus_px * radius_in_focus_px, 0.03 * sum);
  }
}

TEST(Photograph, InFocusAGlowIsWhereThePinholeSeesIt) {
  ThreadPool pool(2);
  const Vec3 glow(0.05, -0.03, 1);
  const RenderCamera camera = Lens(Camera(81, 81, 400), 0.05, 0, 1);
  const Image<float> picture = ThinLensPhotograph(OneGlow(glow), camera, {256, 0}, pool);
  const Vec2 place = *Project(camera.pinhole, glow);
  double sum = 0;
  Vec2 moment = Vec2::Zero();
  for (int y = 0; y < 81; ++y)
    for (int x = 0; x < 81; ++x) {
      const double value = static_cast<double>(picture.at(x, y));
      sum += value;
      moment += value * Vec2(x + 0.5, y + 0.5);
      if ((Vec2(x + 0.5, y + 0.5) - place).norm() > 4) {
        EXPECT_LT(value, 0.01);
      }
    }
  EXPECT_NEAR((moment / sum - place).norm(), 0, 0.02);
}

TEST(Photograph, ALensOfOnePointIsAPinhole) {
  ThreadPool pool(2);
  const Scene scene = WhiteBall({0.2, 0.1, 4}, 1);
  const PinholeCamera camera = Camera(60, 40, 60);
  const Image<float> pinhole = Photograph(scene, camera, 64);
  const Image<float> lens = ThinLensPhotograph(scene, Lens(camera, 0, 0, 2), {64, 0}, pool);
  for (size_t i = 0; i < lens.pixels().size(); ++i)
    EXPECT_NEAR(lens.pixels()[i], pinhole.pixels()[i], 1e-4F);
}

// A white ball in white ambient light has radiance 1, so that the premultiplied colour of each
// pixel equals its alpha.
TEST(Photograph, BeforeTransparentSurroundingsAlphaIsTheShareOfRaysThatMeetASurface) {
  ThreadPool pool(2);
  const Scene scene = WhiteBall({0.2, 0.1, 4}, 1);
  const PinholeCamera camera = Camera(60, 40, 60);
  const Image<float> pinhole = Photograph(scene, camera, 16, Surroundings::kTransparent);
  const Image<float> lens =
      ThinLensPhotograph(scene, Lens(camera, 0.1, 0, 2), {64, 0}, pool, Surroundings::kTransparent);
  for (const Image<float>* picture : {&pinhole, &lens}) {
    ASSERT_EQ(picture->channels(), 4);
    int opaque = 0, between = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 60; ++x) {
        const float alpha = picture->at(x, y, 3);
        ASSERT_NEAR(picture->at(x, y, 1), alpha, 1e-3F);
        opaque += alpha == 1 ? 1 : 0;
        between += alpha > 0 && alpha < 1 ? 1 : 0;
      }
    EXPECT_GT(opaque, 100);
    EXPECT_GT(between, 20);
  }
}

TEST(Photograph, SurroundingsDoNotChangeTheLightOfOpaquePixels) {
  const Scene scene(DescribeChart());
  const PinholeCamera camera = {IntrinsicsFor(*FindBuiltInScene("chart"), 48, 32),
                                *LookAlong({0, 0, -1}, {0, 0, 1}, -Vec3::UnitY())};
  const Image<float> shown = Photograph(scene, camera, 4);
  const Image<float> cut_out = Photograph(scene, camera, 4, Surroundings::kTransparent);
  int opaque = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) {
      const float alpha = cut_out.at(x, y, 3);
      for (int c = 0; c < 3; ++c) {
        if (alpha == 1) {
          ASSERT_NEAR(cut_out.at(x, y, c), shown.at(x, y, c), 1e-6F);
        } else if (alpha == 0) {
          ASSERT_EQ(cut_out.at(x, y, c), 0);
        }
      }
      opaque += alpha == 1 ? 1 : 0;
    }
  EXPECT_GT(opaque, 200);
  EXPECT_LT(opaque, 48 * 32 - 100);
}

TEST(Photograph, PicturesAreTheSameForAnyNumberOfThreads) {
  ThreadPool one(1), three(3);
  const Scene scene(DescribeStillLife());
  const RenderCamera camera = Lens({IntrinsicsFor(*FindBuiltInScene("still-life"), 48, 32),
                                    *LookAlong({0, -0.12, -0.8}, {0, 0.05, 1}, -Vec3::UnitY())},
                                   0.02, 5, 0.7);
  EXPECT_EQ(ThinLensPhotograph(scene, camera, {16, 0}, one).pixels(),
            ThinLensPhotograph(scene, camera, {16, 0}, three).pixels());
}

}  // namespace
}  // namespace lf
