// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lf {
namespace {

Material Glass() {
  Material glass;
  glass.finish = Finish::kGlass;
  glass.colour = Rgb::Ones();
  return glass;
}

Material Mirror() {
  Material mirror;
  mirror.finish = Finish::kMirror;
  mirror.colour = Rgb::Ones();
  return mirror;
}

// Returns a scene of one sphere of radius 1 at the origin.
SceneDescription SphereOf(const Material& material) {
  SceneDescription scene;
  scene.materials = {material};
  scene.spheres = {{Vec3::Zero(), 1, 0}};
  return scene;
}

TEST(Scene, ADiffuseSurfaceUnderAWhiteRoomShowsItsColour) {
  SceneDescription description;
  Material paint;
  paint.colour = {0.7, 0.2, 0.1};
  description.materials = {paint};
  description.panels = {{{0, 0, 1}, Vec3::UnitX(), -Vec3::UnitY(), false, 0}};
  description.room.ambient = Rgb::Ones();
  description.room.floor = description.room.ceiling = Rgb(0, 0, 0.25);
  const Scene scene(description);
  EXPECT_TRUE(scene.RadianceAlong({Vec3::Zero(), {0.1, 0.2, 3}}).isApprox(Rgb(0.7, 0.2, 0.1)));
  EXPECT_TRUE(scene.RadianceAlong({Vec3::Zero(), -Vec3::UnitZ()}).isApprox(Rgb(0, 0, 0.25)));
}

// A ray that passes the centre of a mirror ball of radius 1 at distance h hits it under the angle
// of incidence asin(h). The angle between the direction back and the reflected ray is twice as
// large.
TEST(Scene, AMirrorBallShowsALampUnderTheMirrorAngle) {
  const double h = 0.4;
  const Vec3 normal(h, 0, -std::sqrt(1 - h * h));
  const double turn = 2 * std::asin(h);  // angle between the direction back and the direction out
  const Vec3 out(std::sin(turn), 0, -std::cos(turn));
  SceneDescription description = SphereOf(Mirror());
  description.glows = {{normal + 3 * out, 0.001, Rgb::Constant(7)}};
  const Scene scene(description);
  EXPECT_NEAR(scene.RadianceAlong({{h, 0, -5}, Vec3::UnitZ()})[0], 7, 1e-6);
  EXPECT_LT(scene.RadianceAlong({{h + 0.002, 0, -5}, Vec3::UnitZ()})[0], 0.1);
}

// By Snell's law, applied twice, a ray at height h is turned by 2 (i - r), where sin i = h and sin
// r = h / n. The turn is symmetric about the middle of the chord.
TEST(Scene, AGlassBallBendsARayTwice) {
  const double h = 0.5;
  const double i = std::asin(h), r = std::asin(h / 1.5);
  const double exit_angle = 2 * r - i;  // angle of the exit point, still above the axis
  const Vec3 exit(std::sin(exit_angle), 0, std::cos(exit_angle));
  const Vec3 out(-std::sin(2 * (i - r)), 0, std::cos(2 * (i - r)));
  SceneDescription description = SphereOf(Glass());
  description.glows = {{exit + 2 * out, 0.001, Rgb::Constant(7)}};
  const Scene scene(description);
  const double seen = scene.RadianceAlong({{h, 0, -5}, Vec3::UnitZ()})[0];
  EXPECT_NEAR(seen, 7 * 0.956 * 0.956, 0.05);  // about 4 % are reflected at either surface
  EXPECT_LT(scene.RadianceAlong({{h + 0.002, 0, -5}, Vec3::UnitZ()})[0], 0.1);
}

// Through haze a, a Gaussian of radius r at distance d is seen with the radius sqrt(r^2 + (a d)^2).
// Its radiance decreases as its area grows.
TEST(Scene, HazeSpreadsTheImageOfALampWithoutLosingLight) {
  Material mirror = Mirror();
  mirror.haze_rad = 0.03;
  SceneDescription description;
  description.materials = {mirror};
  description.panels = {{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), false, 0}};
  description.glows = {{{0, 0, -2}, 0.02, Rgb::Constant(7)}};
  const Scene scene(description);
  const Rgb seen = scene.RadianceAlong({{0, 0, -1}, Vec3::UnitZ()});
  EXPECT_NEAR(seen[0], 7 * 0.02 * 0.02 / (0.02 * 0.02 + 0.06 * 0.06), 1e-9);
}

TEST(Scene, TintedGlassColoursByTheWayThroughIt) {
  Material glass = Glass();
  glass.colour = {0.5, 1, 1};
  SceneDescription description = SphereOf(glass);
  description.room.floor = description.room.ceiling = Rgb::Ones();
  const Rgb through = Scene(description).RadianceAlong({{0, 0, -5}, Vec3::UnitZ()});
  EXPECT_NEAR(through[0], 0.04 + 0.96 * 0.96 * 0.25, 1e-9);  // the light passes two radii
  EXPECT_NEAR(through[1], 0.04 + 0.96 * 0.96, 1e-9);
}

TEST(Scene, ThePolishOfAnEvenlyLitRoomChangesNothing) {
  Material china;
  china.colour = Rgb::Ones();
  china.coat = 1;
  SceneDescription description = SphereOf(china);
  description.room.floor = description.room.ceiling = description.room.ambient = Rgb::Ones();
  const Scene scene(description);
  for (const double h : {0.0, 0.3, 0.7, 0.95})
    EXPECT_NEAR(scene.RadianceAlong({{h, 0, -5}, Vec3::UnitZ()})[0], 1, 1e-12);
}

TEST(Scene, LightPathsBetweenFacingMirrorsEnd) {
  SceneDescription description;
  description.materials = {Mirror()};
  description.panels = {{{0, 0, 1}, Vec3::UnitX(), Vec3::UnitY(), false, 0},
                        {{0, 0, -1}, Vec3::UnitX(), Vec3::UnitY(), false, 0}};
  description.room.floor = description.room.ceiling = Rgb::Ones();
  EXPECT_EQ(Scene(description).RadianceAlong({Vec3::Zero(), Vec3::UnitZ()})[0], 0);
}

TEST(Scene, TheLengthOfARaysDirectionDoesNotMatter) {
  SceneDescription description = SphereOf(Glass());
  description.glows = {{{0.1, 0.2, 4}, 0.3, Rgb::Constant(3)}};
  const Scene scene(description);
  const Vec3 direction(0.05, 0.02, 1);
  const Rgb a = scene.RadianceAlong({{0, 0, -5}, direction});
  const Rgb b = scene.RadianceAlong({{0, 0, -5}, 40 * direction});
  EXPECT_TRUE(a.isApprox(b, 1e-9));
}

}  // namespace
}  // namespace lf
