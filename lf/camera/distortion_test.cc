// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/distortion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lf/core/random.h"

namespace lf {
namespace {

struct Lens {
  std::string name;
  Distortion distortion;
  double widest_rad;  // largest tested angle from the optical axis
};

std::vector<Lens> Lenses() {
  using enum DistortionModel;
  return {{"none", {}, 1.4},
          {"simple radial", {kRadialTangential, {0.035}}, 0.9},
          {"barrel", {kRadialTangential, {-0.25, 0.07}}, 0.7},
          {"tangential", {kRadialTangential, {-0.28, 0.09, 0.002, -0.003}}, 0.7},
          {"rational", {kRadialTangential, {0.3, -0.1, 5e-4, -2e-4, 0.02, 0.6, -0.05, 0.01}}, 0.8},
          {"four radial terms", {kBrown, {-0.09, -0.076, 1e-3, -2e-3, 0.116, -0.076}}, 0.75},
          {"fish-eye", {kFisheye, {-0.02, 0.004, -0.002, 3e-4}}, 1.7},
          {"fov", {kFov, {0.93}}, 1.5},
          {"equidistant", {kFisheye, {}}, 1.7},
          {"division, barrel", {kDivision, {-0.3}}, 1.3},
          {"division, pincushion", {kDivision, {0.2}}, 0.8},
          {"unified", {kUnified, {0.6, 1.1}}, 1.3},
          {"thin prism", {kThinPrism, {-0.02, 0.004, 1e-3, -2e-3, -0.002, 3e-4, 2e-3, -1e-3}}, 1.2},
          {"radial tangential thin prism",
           {kRadialTangentialThinPrism,
            {-0.02, 0.006, -0.002, 5e-4, -1e-4, 2e-5, 0.01, -0.02, 0.008, -0.004, -0.006, 0.003}},
           1.2}};
}

Vec3 RandomDirection(uint64_t index, double widest_rad) {
  const double theta = widest_rad * std::sqrt(RandomUnit(5, 0, index));
  const double phi = 2 * kPi * RandomUnit(5, 1, index);
  return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}

// The formulas of distortion.h, written with powers instead of nested products.
Vec2 ByFormula(const Distortion& distortion, const Vec3& direction) {
  const DistortionParameters& p = distortion.parameters;
  const double x = direction.x() / direction.z(), y = direction.y() / direction.z();
  const double r = std::hypot(x, y);
  const double theta = std::atan2(std::hypot(direction.x(), direction.y()), direction.z());
  switch (distortion.model) {
    case DistortionModel::kNone:
      return {x, y};
    case DistortionModel::kRadialTangential: {
      const double above =
          1 + p[0] * std::pow(r, 2) + p[1] * std::pow(r, 4) + p[4] * std::pow(r, 6);
      const double below =
          1 + p[5] * std::pow(r, 2) + p[6] * std::pow(r, 4) + p[7] * std::pow(r, 6);
      return {x * above / below + 2 * p[2] * x * y + p[3] * (r * r + 2 * x * x),
              y * above / below + p[2] * (r * r + 2 * y * y) + 2 * p[3] * x * y};
    }
    case DistortionModel::kBrown: {
      const double radial = 1 + p[0] * std::pow(r, 2) + p[1] * std::pow(r, 4) +
                            p[4] * std::pow(r, 6) + p[5] * std::pow(r, 8);
      return {x * radial + 2 * p[2] * x * y + p[3] * (r * r + 2 * x * x),
              y * radial + p[2] * (r * r + 2 * y * y) + 2 * p[3] * x * y};
    }
    case DistortionModel::kFisheye: {
      double rd = theta;
      for (int i = 0; i < 4; ++i) rd += p[i] * std::pow(theta, 2 * i + 3);
      return rd / std::hypot(direction.x(), direction.y()) * direction.head<2>();
    }
    case DistortionModel::kFov:
      return std::atan(2 * r * std::tan(p[0] / 2)) / (p[0] * r) * Vec2(x, y);
    case DistortionModel::kDivision:
      return (1 - std::sqrt(1 - 4 * p[0] * r * r)) / (2 * p[0] * r * r) * Vec2(x, y);
    case DistortionModel::kUnified:
      return Vec2(x, y) / (p[0] * std::sqrt(p[1] * r * r + 1) + 1 - p[0]);
    case DistortionModel::kThinPrism: {
      const Vec2 at = theta / std::hypot(direction.x(), direction.y()) * direction.head<2>();
      const double u = at.x(), v = at.y(), s = theta * theta;
      const double radial =
          p[0] * s + p[1] * std::pow(s, 2) + p[4] * std::pow(s, 3) + p[5] * std::pow(s, 4);
      return {u + u * radial + 2 * p[2] * u * v + p[3] * (s + 2 * u * u) + p[6] * s,
              v + v * radial + 2 * p[3] * u * v + p[2] * (s + 2 * v * v) + p[7] * s};
    }
    case DistortionModel::kRadialTangentialThinPrism: {
      double bent = theta;
      for (int i = 0; i < 6; ++i) bent += p[i] * std::pow(theta, 2 * i + 3);
      const Vec2 at = bent / std::hypot(direction.x(), direction.y()) * direction.head<2>();
      const double a = at.x(), b = at.y(), q = bent * bent;
      return {a + p[6] * (q + 2 * a * a) + 2 * p[7] * a * b + p[8] * q + p[9] * q * q,
              b + p[7] * (q + 2 * b * b) + 2 * p[6] * a * b + p[10] * q + p[11] * q * q};
    }
  }
  return Vec2::Zero();
}

TEST(Distortion, FollowsTheFormulaOfEveryModel) {
  for (const Lens& lens : Lenses()) {
    const DistortionMap map(lens.distortion);
    for (uint64_t i = 0; i < 2000; ++i) {
      const Vec3 direction = 3 * RandomDirection(i, lens.widest_rad);
      EXPECT_LE((*map.Distort(direction) - ByFormula(lens.distortion, direction)).norm(), 1e-12)
          << lens.name << " " << direction.transpose();
    }
  }
}

// Thesis 2.2.4: (x, y) times 1 + k1 r^2 + k2 r^4. At (0.3, 0.4), r^2 is 0.25, so that k1 = -0.2 and
// k2 = 0.08 give 1 - 0.05 + 0.005; p1 = 0.01 and p2 = -0.02 add (-0.0062, 0.0009).
TEST(Distortion, AKnownPointIsBentByTheNumbersOfTheThesis) {
  const DistortionMap radial({DistortionModel::kRadialTangential, {-0.2, 0.08}});
  EXPECT_LE((*radial.Distort({0.6, 0.8, 2}) - Vec2(0.2865, 0.382)).norm(), 1e-15);
  const DistortionMap both({DistortionModel::kRadialTangential, {-0.2, 0.08, 0.01, -0.02}});
  EXPECT_LE((*both.Distort({0.6, 0.8, 2}) - Vec2(0.2803, 0.3829)).norm(), 1e-15);
  EXPECT_LE((*both.Undistort({0.2803, 0.3829}) - Vec3(0.3, 0.4, 1)).norm(), 1e-12);
}

TEST(Distortion, BothDirectionsAreInverse) {
  constexpr double kFocal_px = 1000;
  for (const Lens& lens : Lenses()) {
    const DistortionMap map(lens.distortion);
    for (uint64_t i = 0; i < 10000; ++i) {
      const Vec3 direction = RandomDirection(i, lens.widest_rad);
      const std::optional<Vec2> distorted = map.Distort(direction);
      ASSERT_TRUE(distorted) << lens.name;
      const std::optional<Vec3> back = map.Undistort(*distorted);
      ASSERT_TRUE(back) << lens.name << " " << distorted->transpose();
      EXPECT_LE((back->normalized() - direction).norm(), 1e-11) << lens.name;
      const std::optional<Vec2> again = map.Distort(*back);
      ASSERT_TRUE(again) << lens.name;
      EXPECT_LE(kFocal_px * (*again - *distorted).norm(), 1e-9) << lens.name;
    }
  }
}

TEST(Distortion, TheOpticalAxisStaysWithoutTangentialTerms) {
  for (const Lens& lens : Lenses()) {
    const DistortionMap map(lens.distortion);
    EXPECT_EQ(map.Distort({0, 0, 3}), Vec2(0, 0)) << lens.name;
    const std::optional<Vec3> axis = map.Undistort({0, 0});
    ASSERT_TRUE(axis) << lens.name;
    EXPECT_EQ(axis->normalized(), Vec3(0, 0, 1)) << lens.name;
  }
}

TEST(Distortion, DirectionsAreSmoothOverTheImage) {
  for (const Lens& lens : Lenses()) {
    const DistortionMap map(lens.distortion);
    for (double x = -0.4; x < 0.4; x += 0.013) {
      const Vec3 a = *map.Undistort({x, 0.1}), b = *map.Undistort({x + 1e-6, 0.1});
      EXPECT_LE((a - b).norm(), 1e-5) << lens.name;
    }
  }
}

// x (1 - 0.3 x^2) grows up to x = 1 / sqrt(0.9) only.
TEST(Distortion, NoRayArrivesBeyondTheFold) {
  const DistortionMap map({DistortionModel::kRadialTangential, {-0.3}});
  const double fold = 1 / std::sqrt(0.9), distorted_fold = fold * (1 - 0.3 / 0.9);
  EXPECT_TRUE(map.Distort({fold - 1e-6, 0, 1}));
  EXPECT_FALSE(map.Distort({fold + 1e-6, 0, 1}));
  EXPECT_FALSE(map.Distort({3, 0, 1}));
  EXPECT_TRUE(map.Undistort({distorted_fold - 1e-9, 0}));
  EXPECT_FALSE(map.Undistort({distorted_fold + 1e-9, 0}));
  EXPECT_NEAR(map.Undistort({distorted_fold - 1e-12, 0})->x(), fold, 1e-5);
}

TEST(Distortion, WithTangentialTermsTooNoRayArrivesBeyondTheFold) {
  const DistortionMap map({DistortionModel::kRadialTangential, {-0.3, 0, 0.001, 0.001}});
  EXPECT_TRUE(map.Undistort({0.69, 0.1}));
  EXPECT_FALSE(map.Undistort({0.8, 0.1}));
  EXPECT_FALSE(map.Distort({3, 0, 1}));
}

// Limits are remembered, of fewer lenses than there are here.
TEST(Distortion, EachOfManyLensesFoldsAtItsOwnRadius) {
  for (int round = 0; round < 3; ++round)
    for (int lens = 1; lens <= 20; ++lens)
      for (int made = 0; made < 2; ++made) {
        const double k1 = -0.05 * lens;
        const DistortionMap map({DistortionModel::kRadialTangential, {k1}});
        const double fold = std::sqrt(-1 / (3 * k1));  // r + k1 r^3 stops growing
        EXPECT_TRUE(map.Distort({0.999 * fold, 0, 1})) << k1;
        EXPECT_FALSE(map.Distort({1.001 * fold, 0, 1})) << k1;
        EXPECT_TRUE(map.Undistort({0.999 * fold * 2 / 3, 0})) << k1;
        EXPECT_FALSE(map.Undistort({1.001 * fold * 2 / 3, 0})) << k1;
      }
}

TEST(Distortion, OnlyLensesAreDistortions) {
  using enum DistortionModel;
  EXPECT_TRUE(IsDistortion({kUnified, {0.5, 1}}));
  EXPECT_FALSE(IsDistortion({kUnified, {1.1, 1}}));
  EXPECT_FALSE(IsDistortion({kUnified, {0.5, 0}}));
  EXPECT_FALSE(IsDistortion({kFov, {0}}));
  EXPECT_FALSE(IsDistortion({kFov, {4}}));
  EXPECT_TRUE(IsDistortion({kDivision, {-7}}));
}

TEST(Distortion, DivisionAndUnifiedLensesEndWhereTheyTurnBack) {
  using enum DistortionModel;
  const DistortionMap pincushion({kDivision, {0.25}});  // r(rd) has its maximum, 1, at rd = 2
  EXPECT_TRUE(pincushion.Distort({0.999, 0, 1}));
  EXPECT_FALSE(pincushion.Distort({1.001, 0, 1}));
  EXPECT_TRUE(pincushion.Undistort({1.999, 0}));
  EXPECT_FALSE(pincushion.Undistort({2.001, 0}));
  const DistortionMap barrel({kDivision, {-0.25}});  // rd = 2 at 90 degrees
  EXPECT_NEAR(barrel.Distort({1e9, 0, 1})->x(), 2, 1e-6);
  EXPECT_FALSE(barrel.Undistort({0, 2.001}));
  const DistortionMap unified({kUnified, {0.5, 4}});  // rd = 1 at 90 degrees
  EXPECT_NEAR(unified.Distort({1e9, 0, 1})->x(), 1, 1e-6);
  EXPECT_TRUE(unified.Undistort({0.999, 0}));
  EXPECT_FALSE(unified.Undistort({1.001, 0}));
}

TEST(Distortion, OnlyAFishEyeSeesBehindItself) {
  for (const Lens& lens : Lenses()) {
    const bool sees = DistortionMap(lens.distortion).Distort({1, 0, -0.1}).has_value();
    EXPECT_EQ(sees, lens.distortion.model == DistortionModel::kFisheye ||
                        lens.distortion.model == DistortionModel::kThinPrism ||
                        lens.distortion.model == DistortionModel::kRadialTangentialThinPrism)
        << lens.name;
  }
}

TEST(Distortion, TheIdealFishEyeIsLinearInTheAngle) {
  const DistortionMap map({DistortionModel::kFisheye, {}});
  EXPECT_NEAR(map.Distort({std::sin(0.5), 0, std::cos(0.5)})->x(), 0.5, 1e-15);
  EXPECT_NEAR(map.Distort({0, std::sin(2.5), std::cos(2.5)})->y(), 2.5, 1e-15);
  EXPECT_FALSE(map.Undistort({3.2, 0}));
}

TEST(Distortion, APoleOfTheDenominatorEndsTheImage) {
  // 1 - 4 r^2 vanishes at r = 0.5.
  const DistortionMap map({DistortionModel::kRadialTangential, {0, 0, 0, 0, 0, -4}});
  EXPECT_TRUE(map.Distort({0.499, 0, 1}));
  EXPECT_FALSE(map.Distort({0.501, 0, 1}));
}

}  // namespace
}  // namespace lf
