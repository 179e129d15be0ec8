// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/lighting.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

const Vec3 kUp = -Vec3::UnitY();

double LightAt(const Lighting& lighting, const Vec3& point) {
  return lighting.DiffuseLight(point, kUp)[1];
}

TEST(Lighting, LightFallsWithTheSquareOfTheDistanceAndTheCosine) {
  const Lighting lighting({{{0, -2, 0}, 0.1, Rgb::Constant(8)}}, {}, Rgb::Zero());
  EXPECT_NEAR(LightAt(lighting, Vec3::Zero()), 2, 1e-12);
  EXPECT_NEAR(LightAt(lighting, {2, 0, 0}), 8 / 8.0 * std::sqrt(0.5), 1e-12);
  EXPECT_EQ(lighting.DiffuseLight(Vec3::Zero(), -kUp)[1], 0);  // the lamp is behind the surface
}

TEST(Lighting, ASphereThrowsAShadowWithASoftRim) {
  const Lighting lighting({{{0, -2, 0}, 0.1, Rgb::Constant(8)}},
                          {{{{0, -1, 0}, 0.2, 0}, false, Rgb::Ones()}}, Rgb::Zero());
  const Lighting bare({{{0, -2, 0}, 0.1, Rgb::Constant(8)}}, {}, Rgb::Zero());
  EXPECT_EQ(LightAt(lighting, Vec3::Zero()), 0);
  double before = 0;
  for (int i = 0; i < 80; ++i) {
    const double x = 0.01 * i;
    const double share = LightAt(lighting, {x, 0, 0}) / LightAt(bare, {x, 0, 0});
    EXPECT_GE(share, before);
    before = share;
  }
  EXPECT_DOUBLE_EQ(before, 1);
  // By similar triangles, the core of the shadow ends at 0.2 + (0.2 - 0.1), and half of the light
  // is reached at 2 x 0.2.
  EXPECT_NEAR(LightAt(lighting, {0.3, 0, 0}), 0, 0.1);
  EXPECT_NEAR(LightAt(lighting, {0.405, 0, 0}) / LightAt(bare, {0.405, 0, 0}), 0.5, 0.05);
}

TEST(Lighting, ASphereBehindTheLampOrTouchingThePointHidesNothing) {
  const Lamp lamp{{0, -2, 0}, 0.1, Rgb::Constant(8)};
  const Lighting behind({lamp}, {{{{0, -4, 0}, 0.5, 0}, false, Rgb::Ones()}}, Rgb::Zero());
  EXPECT_NEAR(LightAt(behind, Vec3::Zero()), 2, 1e-12);
  const Lighting on_top({lamp}, {{{{0, 0.3, 0}, 0.3, 0}, false, Rgb::Ones()}}, Rgb::Zero());
  EXPECT_NEAR(LightAt(on_top, Vec3::Zero()), 2, 1e-12);
}

TEST(Lighting, GlassGathersTheLightOfItsShadowInTheMiddle) {
  const Lamp lamp{{0, -2, 0}, 0.02, Rgb::Constant(8)};
  const Rgb green(0.2, 1, 0.2);
  const Lighting lighting({lamp}, {{{{0, -0.3, 0}, 0.2, 0}, true, green}}, Rgb::Zero());
  const Rgb middle = lighting.DiffuseLight(Vec3::Zero(), kUp);
  EXPECT_GT(middle[1], 4);                       // without the sphere, it is 2
  EXPECT_NEAR(middle[0], 0.2 * middle[1], 0.1);  // in the colour of the glass
  EXPECT_LT(LightAt(lighting, {0.2, 0, 0}), 1);  // while its surroundings are darker
}

TEST(Lighting, TheRoomIsDarkerBesideASphere) {
  const Lighting lighting({}, {{{{0, -0.1, 0}, 0.1, 0}, false, Rgb::Ones()}}, Rgb::Ones());
  EXPECT_LT(LightAt(lighting, {0.01, 0, 0}), 0.1);
  EXPECT_GT(LightAt(lighting, {0.3, 0, 0}), 0.9);
  EXPECT_DOUBLE_EQ(LightAt(lighting, {2, 0, 0}), 1);
}

TEST(Lighting, HiddenSharesGoFromAllToNothing) {
  EXPECT_EQ(HiddenShare(0.1, 0.2, 0.05), 1);
  EXPECT_EQ(HiddenShare(0.1, 0.2, 0.31), 0);
  EXPECT_DOUBLE_EQ(HiddenShare(0.2, 0.1, 0), 0.25);  // an eclipse that leaves a ring
  EXPECT_DOUBLE_EQ(HiddenShare(0.1, 0.2, 0.2), 0.5);
}

}  // namespace
}  // namespace lf
