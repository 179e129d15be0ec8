// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lf/core/geometry.h"

namespace lf {
namespace {

MotionValue Number(double value) { return MotionValue::Constant(1, value); }

Key NumberKey(double time_s, double value, Interpolation interpolation = Interpolation::kSmooth) {
  return {time_s, Number(value), interpolation};
}

KeyframeCurve Numbers(std::vector<Key> keys) {
  return KeyframeCurve(std::move(keys), SmoothCurve::kMonotone);
}

KeyframeCurve Points(const std::vector<std::pair<double, Vec3>>& points) {
  std::vector<Key> keys;
  for (const auto& [time_s, point] : points)
    keys.push_back({time_s, point, Interpolation::kSmooth});
  return KeyframeCurve(std::move(keys), SmoothCurve::kCatmullRom);
}

MotionValue SpeedAt(const KeyframeCurve& curve, double time_s) {
  constexpr double kStep_s = 1e-6;
  return (curve.At(time_s + kStep_s) - curve.At(time_s - kStep_s)) / (2 * kStep_s);
}

TEST(AcceleratedMotion, WithoutPeriodsKeepsItsSpeed) {
  const AcceleratedMotion motion{Number(1), Number(0.5), {}};
  EXPECT_DOUBLE_EQ(ValueAt(motion, 0)[0], 1);
  EXPECT_DOUBLE_EQ(ValueAt(motion, 4)[0], 3);
}

TEST(AcceleratedMotion, FollowsTheFormulasOfConstantAcceleration) {
  // The acceleration is 2/s^2 from 1 s to 3 s; the motion starts at 10 with speed 1.
  const AcceleratedMotion motion{Number(10), Number(1), {{1, 3, Number(2)}}};
  EXPECT_DOUBLE_EQ(ValueAt(motion, 1)[0], 11);
  EXPECT_DOUBLE_EQ(ValueAt(motion, 2)[0], 12 + 1);
  EXPECT_DOUBLE_EQ(ValueAt(motion, 3)[0], 13 + 4);
  // After the period, the reached speed 1 + 2 * 2 = 5 is kept.
  EXPECT_DOUBLE_EQ(ValueAt(motion, 4)[0], 17 + 5);
  EXPECT_DOUBLE_EQ(ValueAt(motion, 6)[0], 17 + 15);
}

TEST(AcceleratedMotion, PeriodsThatOverlapAddUp) {
  const AcceleratedMotion both{Number(0), Number(0), {{0, 2, Number(1)}, {1, 3, Number(4)}}};
  const AcceleratedMotion one{Number(0), Number(0), {{0, 2, Number(1)}}};
  const AcceleratedMotion other{Number(0), Number(0), {{1, 3, Number(4)}}};
  for (const double t : {0.5, 1.5, 2.5, 5.0})
    EXPECT_NEAR(ValueAt(both, t)[0], ValueAt(one, t)[0] + ValueAt(other, t)[0], 1e-12);
}

TEST(AcceleratedMotion, AccelerationAndBrakingComeToRest) {
  const AcceleratedMotion motion{
      Vec3(0, 0, 0), Vec3(0, 0, 0), {{0, 1, Vec3(2, 0, 0)}, {1, 2, Vec3(-2, 0, 0)}}};
  EXPECT_NEAR((ValueAt(motion, 2) - Vec3(2, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((ValueAt(motion, 9) - Vec3(2, 0, 0)).norm(), 0, 1e-12);
}

TEST(Keyframes, HoldBeforeTheFirstAndAfterTheLast) {
  const KeyframeCurve curve = Numbers({NumberKey(1, 5), NumberKey(2, 7)});
  EXPECT_EQ(curve.At(0)[0], 5);
  EXPECT_EQ(curve.At(1)[0], 5);
  EXPECT_EQ(curve.At(2)[0], 7);
  EXPECT_EQ(curve.At(100)[0], 7);
}

TEST(Keyframes, InterpolationSaysHowAKeyIsReached) {
  const KeyframeCurve curve = Numbers({NumberKey(0, 0), NumberKey(1, 4, Interpolation::kStep),
                                       NumberKey(2, 8, Interpolation::kLinear)});
  EXPECT_EQ(curve.At(0.999)[0], 0);
  EXPECT_EQ(curve.At(1)[0], 4);
  EXPECT_DOUBLE_EQ(curve.At(1.25)[0], 5);
}

TEST(Keyframes, ASmoothStretchDoesNotSeeBeyondAStep) {
  const std::vector<Key> two{NumberKey(0, 0), NumberKey(1, 1)};
  std::vector<Key> and_a_step = two;
  and_a_step.push_back(NumberKey(2, 100, Interpolation::kStep));
  for (const double t : {0.2, 0.5, 0.9})
    EXPECT_DOUBLE_EQ(Numbers(two).At(t)[0], Numbers(and_a_step).At(t)[0]);
}

TEST(Keyframes, NoApertureOvershootsBelowZero) {
  const KeyframeCurve curve =
      Numbers({NumberKey(0, 4), NumberKey(1, 0.01), NumberKey(1.1, 0), NumberKey(3, 5)});
  for (int i = 0; i <= 300; ++i) EXPECT_GE(curve.At(i / 100.0)[0], 0);
}

TEST(Keyframes, EveryComponentOfATiltMovesByItself) {
  const KeyframeCurve curve({{0, Vec2(0, 3), {}}, {1, Vec2(1, 3), {}}, {2, Vec2(2, 3), {}}},
                            SmoothCurve::kMonotone);
  EXPECT_NEAR((curve.At(1.5) - Vec2(1.5, 3)).norm(), 0, 1e-12);
}

TEST(Keyframes, APathOfPointsPassesThroughThem) {
  const std::vector<std::pair<double, Vec3>> keys{
      {0, {0, 0, 0}}, {0.5, {1, 2, 0}}, {3, {1, 2.1, 5}}, {4, {-3, 0, 0}}};
  const KeyframeCurve curve = Points(keys);
  for (const auto& [time_s, point] : keys) EXPECT_NEAR((curve.At(time_s) - point).norm(), 0, 1e-12);
}

TEST(Keyframes, APathOfPointsHasNoJumpInSpeed) {
  // Times are not proportional to distances.
  const KeyframeCurve curve =
      Points({{0, {0, 0, 0}}, {2, {1, 0, 0}}, {2.5, {1, 3, 0}}, {4, {2, 3, 1}}});
  for (const double key_s : {2.0, 2.5})
    EXPECT_NEAR((SpeedAt(curve, key_s - 1e-4) - SpeedAt(curve, key_s + 1e-4)).norm(), 0, 0.02);
}

TEST(Keyframes, TwoPointsAreAStraightLineAtConstantSpeed) {
  const KeyframeCurve curve = Points({{0, {1, 1, 1}}, {2, {5, 1, -1}}});
  EXPECT_NEAR((curve.At(0.5) - Vec3(2, 1, 0.5)).norm(), 0, 1e-12);
}

TEST(Keyframes, ARepeatedPointIsARest) {
  const KeyframeCurve curve =
      Points({{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {1, 0, 0}}, {3, {2, 1, 0}}});
  for (const double t : {1.0, 1.3, 1.9}) EXPECT_EQ(curve.At(t), MotionValue(Vec3(1, 0, 0)));
  EXPECT_NEAR(SpeedAt(curve, 1).norm(), 0, 1e-4);
}

constexpr Interpolation kEase = Interpolation::kEase, kEaseIn = Interpolation::kEaseIn,
                        kEaseOut = Interpolation::kEaseOut, kLinear = Interpolation::kLinear;

TEST(Ease, IsTheQuinticBetweenTwoRests) {
  const KeyframeCurve curve = Numbers({NumberKey(1, 3), NumberKey(5, 13, kEase)});
  for (const double x : {0.1, 0.25, 0.5, 0.75, 0.9})
    EXPECT_NEAR(curve.At(1 + 4 * x)[0],
                3 + 10 * (10 * x * x * x - 15 * x * x * x * x + 6 * x * x * x * x * x), 1e-12);
  // The greatest speed, in the middle, is 15 / 8 of the mean speed 10 / 4.
  EXPECT_NEAR(SpeedAt(curve, 3)[0], 15.0 / 8 * 10 / 4, 1e-6);
}

TEST(Ease, HasNoJerkAboveSixtyTimesTheWayPerCubedDuration) {
  // The curve rests at 1 before its first key and at 2 after the next, so that the bound holds
  // across the keys.
  constexpr double kFps = 48, kWay = 2, kDuration_s = 1.5;
  const KeyframeCurve curve = Numbers({NumberKey(0.5, 1), NumberKey(0.5 + kDuration_s, 3, kEase)});
  const KeyframeCurve smooth = Numbers({NumberKey(0.5, 1), NumberKey(0.5 + kDuration_s, 3)});
  const auto greatest_jerk = [&](const KeyframeCurve& of) {
    double greatest = 0;
    for (int i = 0; i + 3 < 3 * kFps; ++i) {
      const auto at = [&](int frame) { return of.At(frame / kFps)[0]; };
      const double change = at(i + 3) - 3 * at(i + 2) + 3 * at(i + 1) - at(i);
      greatest = std::max(greatest, std::abs(change) * kFps * kFps * kFps);
    }
    return greatest;
  };
  const double bound = 60 * kWay / (kDuration_s * kDuration_s * kDuration_s);
  EXPECT_LE(greatest_jerk(curve), bound * (1 + 1e-9));
  EXPECT_GT(greatest_jerk(curve), 0.8 * bound);
  EXPECT_GT(greatest_jerk(smooth), 50 * bound);
}

TEST(Ease, OfOneEndReachesTwiceTheMeanSpeed) {
  const KeyframeCurve in = Numbers({NumberKey(0, 0), NumberKey(2, 6, kEaseIn)});
  const KeyframeCurve out = Numbers({NumberKey(0, 6), NumberKey(2, 0, kEaseOut)});
  for (const double x : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(in.At(2 * x)[0], 6 * (2 * x * x * x - x * x * x * x), 1e-12);
    EXPECT_NEAR(out.At(2 - 2 * x)[0], in.At(2 * x)[0], 1e-12);
  }
  EXPECT_NEAR(SpeedAt(in, 1e-4)[0], 0, 1e-6);
  EXPECT_NEAR(SpeedAt(in, 2 - 1e-4)[0], 6, 1e-3);
  EXPECT_NEAR(SpeedAt(out, 2 - 1e-4)[0], 0, 1e-6);
}

TEST(Ease, TakesUpTheSpeedOfALineBesideIt) {
  // The line moves at 4 per second; the eases have mean speeds of 2 and 3.
  const KeyframeCurve curve = Numbers({NumberKey(0, 0), NumberKey(1, 2, kEaseIn),
                                       NumberKey(3, 10, kLinear), NumberKey(4, 13, kEaseOut)});
  for (const double t : {1 - 1e-4, 2.0, 3 + 1e-4}) EXPECT_NEAR(SpeedAt(curve, t)[0], 4, 5e-3);
  EXPECT_NEAR(SpeedAt(curve, 4 - 1e-4)[0], 0, 1e-4);
  const auto speed_before = [](double line) {
    return SpeedAt(
        Numbers({NumberKey(0, 0), NumberKey(1, 1, kEaseIn), NumberKey(2, 1 + line, kLinear)}),
        1 - 1e-4)[0];
  };
  EXPECT_NEAR(speed_before(0.5), 0.5, 5e-3);
  EXPECT_NEAR(speed_before(3), 3, 5e-3);
  EXPECT_NEAR(speed_before(9), 3, 5e-3);
  EXPECT_NEAR(speed_before(0), 0, 5e-3);
  EXPECT_NEAR(speed_before(-2), 0, 5e-3);
}

TEST(Ease, OfPointsTakesUpTheSpeedOfALineBesideIt) {
  const KeyframeCurve curve({{0, Vec3(0, 0, 0), {}},
                             {1, Vec3(2, 0, 0), kEaseIn},
                             {2, Vec3(2, 3, 0), kLinear},
                             {4, Vec3(2, 7, 0), kEaseOut}},
                            SmoothCurve::kCatmullRom);
  EXPECT_NEAR((SpeedAt(curve, 1 - 1e-4) - Vec3(3, 0, 0)).norm(), 0, 5e-3);
  EXPECT_NEAR((SpeedAt(curve, 2 + 1e-4) - Vec3(0, 3, 0)).norm(), 0, 5e-3);
}

TEST(Ease, RestsAtBothEndsOfAStretch) {
  const std::vector<double> values{0, 1, 3, 4};
  std::vector<Key> keys;
  for (size_t i = 0; i < values.size(); ++i)
    keys.push_back(NumberKey(static_cast<double>(i), values[i]));
  const KeyframeCurve smooth = Numbers(keys);
  keys[1].interpolation = kEaseIn;
  keys[3].interpolation = kEaseOut;
  const KeyframeCurve eased = Numbers(keys);
  EXPECT_NEAR(SpeedAt(eased, 1e-4)[0], 0, 1e-6);
  EXPECT_NEAR(SpeedAt(eased, 3 - 1e-4)[0], 0, 1e-6);
  // The speed is that of the smooth keys where these two do not reach, and does not jump.
  for (const double t : {1.0, 1.5, 2.0})
    for (const double side : {-1e-4, 1e-4})
      EXPECT_NEAR(SpeedAt(eased, t + side)[0], SpeedAt(smooth, t)[0], 5e-3) << t;
  for (size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(eased.At(static_cast<double>(i))[0], values[i], 1e-12);
}

TEST(Ease, IsMonotoneBetweenKeys) {
  const std::vector<double> values{0, 1, 1.2, 5, 5.01};
  std::vector<Key> keys;
  for (size_t i = 0; i < values.size(); ++i)
    keys.push_back(NumberKey(static_cast<double>(i), values[i]));
  keys[1].interpolation = kEaseIn;
  keys[4].interpolation = kEaseOut;
  const KeyframeCurve curve = Numbers(keys);
  for (int i = 1; i <= 4000; ++i)
    EXPECT_GE(curve.At(i / 1000.0)[0], curve.At((i - 1) / 1000.0)[0] - 1e-15) << i;
}

TEST(Ease, BeginsANewStretchWhateverIsBesideIt) {
  // The smooth stretch ends at the key at 2 s, with a speed, where the ease begins from rest.
  const KeyframeCurve curve = Numbers(
      {NumberKey(0, 0), NumberKey(1, 1), NumberKey(2, 2), NumberKey(3, 3, kEase), NumberKey(4, 4)});
  EXPECT_NEAR(SpeedAt(curve, 2 - 1e-4)[0], 1, 1e-3);
  EXPECT_NEAR(SpeedAt(curve, 2 + 1e-4)[0], 0, 1e-6);
  EXPECT_NEAR(SpeedAt(curve, 3 - 1e-4)[0], 0, 1e-6);
  EXPECT_NEAR(SpeedAt(curve, 3 + 1e-4)[0], 1, 1e-3);
}

TEST(Ease, OfOnePairOfPointsIsAStraightLine) {
  const KeyframeCurve curve({{0, Vec3(0, 0, 0), {}},
                             {1, Vec3(1, 0, 0), {}},
                             {3, Vec3(1, 4, -2), kEase},
                             {4, Vec3(0, 0, 0), {}}},
                            SmoothCurve::kCatmullRom);
  for (const double x : {0.1, 0.25, 0.5, 0.9}) {
    const double share = x * x * x * (10 - 15 * x + 6 * x * x);
    EXPECT_NEAR((curve.At(1 + 2 * x) - Vec3(1, 4 * share, -2 * share)).norm(), 0, 1e-12);
  }
}

TEST(Ease, OfPointsStaysOnTheCurveOfSmoothKeys) {
  std::vector<Key> keys;
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 0.2, 0), Vec3(1.3, 2, 0.4), Vec3(5, 2, -1)})
    keys.push_back({static_cast<double>(keys.size()), point, Interpolation::kSmooth});
  const KeyframeCurve smooth(keys, SmoothCurve::kCatmullRom);
  keys[1].interpolation = kEaseIn;
  keys[3].interpolation = kEaseOut;
  const KeyframeCurve eased(keys, SmoothCurve::kCatmullRom);
  EXPECT_NEAR(SpeedAt(eased, 1e-4).norm(), 0, 1e-6);
  EXPECT_NEAR(SpeedAt(eased, 3 - 1e-4).norm(), 0, 1e-5);
  for (const double key_s : {1.0, 2.0})
    EXPECT_NEAR((SpeedAt(eased, key_s - 1e-4) - SpeedAt(eased, key_s + 1e-4)).norm(), 0, 0.01);
  for (const double t : {0.2, 0.7, 1.5, 2.4, 2.8}) {
    double nearest = 1;
    for (int i = 0; i <= 30000; ++i)
      nearest = std::min(nearest, (smooth.At(i / 10000.0) - eased.At(t)).norm());
    EXPECT_LT(nearest, 3e-4) << t;
  }
}

// Returns the curve of a camera that turns about its y axis to angles at 0, 1, 2... seconds.
KeyframeCurve Turns(const std::vector<std::pair<double, Interpolation>>& angles_deg) {
  std::vector<Key> keys;
  for (const auto& [angle_deg, interpolation] : angles_deg) {
    const double half_rad = RadiansFromDegrees(angle_deg) / 2;
    keys.push_back({static_cast<double>(keys.size()),
                    Eigen::Vector4d(std::cos(half_rad), 0, std::sin(half_rad), 0), interpolation});
  }
  return {std::move(keys), SmoothCurve::kRotation};
}

double AngleDegAt(const KeyframeCurve& curve, double time_s) {
  const MotionValue q = curve.At(time_s);
  return DegreesFromRadians(2 * std::atan2(q[2], q[0]));
}

TEST(Ease, OfARotationEasesItsAngle) {
  const KeyframeCurve curve = Turns({{10, {}}, {90, kEase}});
  for (const double x : {0.1, 0.25, 0.5, 0.9})
    EXPECT_NEAR(AngleDegAt(curve, x), 10 + 80 * x * x * x * (10 - 15 * x + 6 * x * x), 1e-9);
}

TEST(Ease, OfRotationsHasOneSpeedAtEachKey) {
  const KeyframeCurve curve =
      Turns({{0, {}}, {20, kEaseIn}, {60, Interpolation::kSmooth}, {70, kEaseOut}});
  const auto speed = [&](double t) {
    return (AngleDegAt(curve, t + 1e-5) - AngleDegAt(curve, t - 1e-5)) / 2e-5;
  };
  for (const double t : {1.0, 2.0}) {
    EXPECT_NEAR(speed(t - 1e-3), speed(t + 1e-3), 0.5);
    EXPECT_GT(speed(t), 10);
  }
  EXPECT_NEAR(speed(1e-3), 0, 1e-2);
  EXPECT_NEAR(speed(3 - 1e-3), 0, 1e-2);
  // Without eases, each rotation keeps a constant speed.
  const KeyframeCurve smooth = Turns({{0, {}}, {20, {}}, {60, {}}});
  EXPECT_NEAR(AngleDegAt(smooth, 0.25), 5, 1e-9);
  EXPECT_NEAR(AngleDegAt(smooth, 1.25), 30, 1e-9);
}

TEST(Ease, OfARepeatedPointRests) {
  const KeyframeCurve curve({{0, Vec3(1, 2, 3), {}},
                             {1, Vec3(1, 2, 3), kEase},
                             {2, Vec3(1, 2, 3), kEaseIn},
                             {3, Vec3(1, 2, 3), kEaseOut}},
                            SmoothCurve::kCatmullRom);
  for (const double t : {0.0, 0.5, 1.5, 2.5}) EXPECT_EQ(curve.At(t), MotionValue(Vec3(1, 2, 3)));
}

TEST(Keyframes, OneKeyDoesNotMove) {
  EXPECT_FALSE(Moves(Numbers({NumberKey(0, 4)})));
  EXPECT_TRUE(Moves(Numbers({NumberKey(0, 4), NumberKey(1, 5)})));
  EXPECT_FALSE(Moves(AcceleratedMotion{Number(1), Number(0), {}}));
  EXPECT_TRUE(Moves(AcceleratedMotion{Number(1), Number(2), {}}));
  EXPECT_TRUE(Moves(AcceleratedMotion{Number(1), Number(0), {{1, 2, Number(1)}}}));
}

}  // namespace
}  // namespace lf
