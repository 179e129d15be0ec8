// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/slab.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/core/random.h"

namespace lf {
namespace {

// Returns a slab with planes about 1 apart; the uv plane is tilted.
Slab TiltedSlab() {
  Slab slab;
  slab.st = {Vec3(0.1, -0.2, 0.3), Vec3::UnitX(), Vec3::UnitY()};
  const Vec3 a = Vec3(1, 0.2, 0.3).normalized();
  slab.uv = {Vec3(0, 0.1, 1.4), a, Vec3(-0.3, 1, 0.1).cross(a).normalized().cross(a)};
  slab.uv.axis_b = -slab.uv.axis_b;
  slab.r_st_w = 0.01;
  slab.r_uv_w = 0.003;
  return slab;
}

PinholeCamera CameraNear(RandomSequence& random) {
  PinholeCamera camera;
  camera.intrinsics = {60, 60, 25, 17.5, 0, 50, 35};
  const Vec3 centre(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3), random.Uniform(0, 0.6));
  camera.cam_from_world = *LookAlong(
      centre, Vec3(random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2), 1), -Vec3::UnitY());
  return camera;
}

TEST(Slab, ARayGoesThroughItsPoints) {
  const Slab slab = TiltedSlab();
  RandomSequence random(1);
  for (int i = 0; i < 200; ++i) {
    const SlabPoint point(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1),
                          random.Uniform(-0.5, 0.5));
    const Ray ray = RayOfPoint(slab, point);
    // The origin may be any point of the line, and the direction may have any length.
    const auto back =
        Parameterize(slab, {ray.At(random.Uniform(-2, 3)), random.Uniform(0.1, 9) * ray.direction});
    ASSERT_TRUE(back);
    EXPECT_LT((*back - point).norm(), 1e-12);
    EXPECT_FALSE(Parameterize(slab, {ray.origin, -ray.direction}));
  }
  EXPECT_FALSE(Parameterize(slab, {Vec3::Zero(), Vec3::UnitX()}));
}

TEST(Slab, FormsAreTheRaysOfPixels) {
  const Slab slab = TiltedSlab();
  RandomSequence random(2);
  for (int i = 0; i < 50; ++i) {
    const PinholeCamera camera = CameraNear(random);
    const SlabForms forms = MakeSlabForms(slab, camera);
    for (int k = 0; k < 20; ++k) {
      const double x = random.Uniform(0, 50), y = random.Uniform(0, 35);
      const auto expected = Parameterize(slab, RayOfPixel(camera, x, y));
      const auto found = Parameterize(forms, Vec3(x, y, 1));
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (found) {
        EXPECT_LT((*found - *expected).norm(), 1e-9);
      }
    }
  }
}

TEST(Slab, ACellHoldsItsMiddleAndWhatIsAround) {
  const Slab slab = TiltedSlab();
  RandomSequence random(3);
  for (int i = 0; i < 200; ++i) {
    const SlabPoint point(random.Uniform(-20, 20), random.Uniform(-20, 20), random.Uniform(-20, 20),
                          random.Uniform(-20, 20));
    const auto key = CellOf(slab, point);
    ASSERT_TRUE(key);
    const SlabPoint middle = MiddleOf(slab, *key);
    EXPECT_EQ(CellOf(slab, middle), key);
    for (int k = 0; k < kCellAxes; ++k)
      EXPECT_LE(std::abs(middle[k] - point[k]), (k < 2 ? slab.r_st_w : slab.r_uv_w) / 2 + 1e-9);
  }
}

// The numbers of a cell are (floor(s / r), floor(t / r), floor(u / r), floor(v / r)), thesis Eq.
// 4.3.
TEST(Slab, ACellIsTheFloorsOfItsPoint) {
  const Slab slab = TiltedSlab();
  RandomSequence random(4);
  for (int i = 0; i < 500; ++i) {
    const SlabPoint point(random.Uniform(-2, 2), random.Uniform(-2, 2), random.Uniform(-2, 2),
                          random.Uniform(-2, 2));
    const auto key = CellOf(slab, point);
    ASSERT_TRUE(key);
    for (int k = 0; k < kCellAxes; ++k) {
      const int number = static_cast<int>(*key >> (16 * k) & 0xffff) - kCellOffset;
      EXPECT_EQ(number, static_cast<int>(std::floor(point[k] / (k < 2 ? 0.01 : 0.003))));
    }
  }
}

TEST(Slab, NumbersBeyondSixteenBitsAreNoCell) {
  const Slab slab = TiltedSlab();
  const double far = kMostCells * slab.r_uv_w;
  EXPECT_TRUE(CellOf(slab, SlabPoint(0, 0, 0.999 * far, 0)));
  EXPECT_FALSE(CellOf(slab, SlabPoint(0, 0, 1.001 * far, 0)));
  EXPECT_TRUE(KeyOf(SlabPoint(kMostCells - 0.5, 0, 0, -kMostCells)));
  EXPECT_FALSE(KeyOf(SlabPoint(kMostCells, 0, 0, 0)));
  EXPECT_FALSE(CellOf(slab, SlabPoint(0, 0, 0, -1.001 * far)));
  EXPECT_FALSE(CellOf(slab, SlabPoint(0, 0, 0, std::nan(""))));
  EXPECT_FALSE(CellOf(slab, SlabPoint(std::numeric_limits<double>::infinity(), 0, 0, 0)));
}

}  // namespace
}  // namespace lf
