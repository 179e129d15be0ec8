// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/glows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lf/core/random.h"

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Glows, LightFallsOffAsAGaussianOfTheDistanceFromTheRay) {
  const Glows glows({{{0, 0, 2}, 0.1, {8, 4, 2}}});
  const Rgb centre = glows.Along({Vec3::Zero(), Vec3::UnitZ()}, {}, kInfinity);
  EXPECT_NEAR(centre[0], 8, 1e-12);
  EXPECT_NEAR(centre[2], 2, 1e-12);
  const Rgb beside = glows.Along({{0.1, 0, 0}, Vec3::UnitZ()}, {}, kInfinity);
  EXPECT_NEAR(beside[0], 8 * std::exp(-1), 1e-12);
}

TEST(Glows, ALampBehindTheEndOfTheRayOrItsStartIsNotSeen) {
  const Glows glows({{{0, 0, 2}, 0.1, Rgb::Ones()}});
  EXPECT_EQ(glows.Along({Vec3::Zero(), Vec3::UnitZ()}, {}, 1.99)[0], 0);
  EXPECT_EQ(glows.Along({{0, 0, 2.01}, Vec3::UnitZ()}, {}, kInfinity)[0], 0);
  EXPECT_GT(glows.Along({Vec3::Zero(), Vec3::UnitZ()}, {}, 2.01)[0], 0.9);
}

// The light of a glow summed over a grid of pixels is the glow's total light, even if the glow is
// much smaller than a pixel.
TEST(Glows, AFootprintLosesNoLight) {
  for (const double radius_w : {0.2, 0.02, 0.002}) {
    const Glows glows({{{0.013, -0.007, 1}, radius_w, Rgb::Constant(5)}});
    const double pixel_w = 0.05;
    double sum = 0;
    for (int y = -30; y <= 30; ++y)
      for (int x = -30; x <= 30; ++x)
        sum +=
            glows.Along({{x * pixel_w, y * pixel_w, 0}, Vec3::UnitZ()}, {pixel_w, 0}, kInfinity)[1];
    EXPECT_NEAR(sum * pixel_w * pixel_w, 5 * kPi * radius_w * radius_w,
                0.003 * 5 * kPi * radius_w * radius_w);
  }
}

TEST(Glows, NoneOfManyIsLost) {
  std::vector<Glow> several;
  for (uint64_t i = 0; i < 43; ++i)
    several.push_back({{RandomUnit(1, 0, i), RandomUnit(1, 1, i), 1 + RandomUnit(1, 2, i)},
                       0.01 + 0.05 * RandomUnit(1, 3, i),
                       Rgb::Ones()});
  const Glows glows(several);
  for (uint64_t i = 0; i < 2000; ++i) {
    const Ray ray{
        {RandomUnit(2, 0, i), RandomUnit(2, 1, i), 3 * RandomUnit(2, 2, i)},
        (Vec3(RandomUnit(2, 3, i), RandomUnit(2, 4, i), RandomUnit(2, 5, i)) - Vec3::Constant(0.5))
            .normalized()};
    const Footprint footprint{0.05 * RandomUnit(2, 6, i), 0.1 * RandomUnit(2, 7, i) - 0.05};
    const double end = 2 * RandomUnit(2, 8, i);
    double expected = 0;
    for (const Glow& glow : several) expected += Glows({glow}).Along(ray, footprint, end)[0];
    EXPECT_NEAR(glows.Along(ray, footprint, end)[0], expected, 1e-12);
  }
}

}  // namespace
}  // namespace lf
