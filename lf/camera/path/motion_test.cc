// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/motion.h"

#include <gtest/gtest.h>

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

Vec3 SpeedAt(const KeyframeCurve& curve, double time_s) {
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

TEST(Keyframes, OneKeyDoesNotMove) {
  EXPECT_FALSE(Moves(Numbers({NumberKey(0, 4)})));
  EXPECT_TRUE(Moves(Numbers({NumberKey(0, 4), NumberKey(1, 5)})));
  EXPECT_FALSE(Moves(AcceleratedMotion{Number(1), Number(0), {}}));
  EXPECT_TRUE(Moves(AcceleratedMotion{Number(1), Number(2), {}}));
  EXPECT_TRUE(Moves(AcceleratedMotion{Number(1), Number(0), {{1, 2, Number(1)}}}));
}

}  // namespace
}  // namespace lf
