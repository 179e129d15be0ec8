// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/optics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

Vec3 RandomDirection(uint64_t i) {
  return Vec3(RandomUnit(3, 0, i) - 0.5, RandomUnit(3, 1, i) - 0.5, RandomUnit(3, 2, i) - 0.5)
      .normalized();
}

TEST(Optics, AMirrorReturnsLightUnderTheAngleOfIncidence) {
  for (uint64_t i = 0; i < 200; ++i) {
    const Vec3 in = RandomDirection(2 * i), normal = RandomDirection(2 * i + 1);
    const Vec3 out = Reflected(in, normal);
    EXPECT_NEAR(out.norm(), 1, 1e-12);
    EXPECT_NEAR(out.dot(normal), -in.dot(normal), 1e-12);
    EXPECT_NEAR(out.cross(normal).dot(in), 0, 1e-12);  // all three lie in one plane
  }
}

TEST(Optics, GlassBendsLightBySnellsLaw) {
  const double angle = RadiansFromDegrees(40);
  const Vec3 in(std::sin(angle), -std::cos(angle), 0);
  const Vec3 out = *Refracted(in, Vec3::UnitY(), 1 / 1.5);
  EXPECT_NEAR(out.norm(), 1, 1e-12);
  EXPECT_NEAR(1.5 * out.x(), std::sin(angle), 1e-12);
  EXPECT_LT(out.y(), 0);
  EXPECT_NEAR(out.z(), 0, 1e-15);
}

TEST(Optics, BeyondTheCriticalAngleNoLightLeavesGlass) {
  const double critical = std::asin(1 / 1.5);
  const auto at = [](double angle) { return Vec3(std::sin(angle), -std::cos(angle), 0); };
  EXPECT_TRUE(Refracted(at(critical - 0.001), Vec3::UnitY(), 1.5));
  EXPECT_FALSE(Refracted(at(critical + 0.001), Vec3::UnitY(), 1.5));
}

TEST(Optics, GlassReflectsFourPercentStraightOnAndAllAtGrazing) {
  EXPECT_NEAR(Reflectance(1, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(Reflectance(0, 1.5), 1, 1e-12);
}

TEST(Optics, AtBrewstersAngleOnlyOnePolarisationIsReflected) {
  // At this angle the angles inside and outside the glass add up to 90 degrees, so r_s = (1 - n^2)
  // / (1 + n^2).
  const double r = (1 - 2.25) / (1 + 2.25);
  EXPECT_NEAR(Reflectance(std::cos(std::atan(1.5)), 1.5), 0.5 * r * r, 1e-12);
}

}  // namespace
}  // namespace lf
