// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/ideal_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace lf {
namespace {

struct Case {
  std::string name;
  Intrinsics k;
};

std::vector<Case> Cameras() {
  using enum DistortionModel;
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, double focal_px, const Distortion& distortion) {
    cases.push_back({name, {focal_px, focal_px * 1.01, 155.3, 122.7, 0.4, 320, 240, distortion}});
  };
  add("phone", 270, {kRadialTangential, {0.035}});
  add("barrel", 250, {kRadialTangential, {-0.25, 0.07, 0.002, -0.003}});
  add("rational", 300, {kRadialTangential, {0.3, -0.1, 5e-4, -2e-4, 0.02, 0.6, -0.05, 0.01}});
  add("fish-eye", 110, {kFisheye, {-0.02, 0.004, -0.002, 3e-4}});
  add("fov", 240, {kFov, {0.93}});
  return cases;
}

TEST(IdealPixels, PatchesHoldEveryPixelOnceAndAgreeWithTheIteration) {
  for (const Case& camera : Cameras()) {
    const DistortionMap map(camera.k.distortion);
    const IdealPixels pixels(camera.k);
    std::vector<int> covered(320 * 240);
    for (const IdealPatch& patch : pixels.patches())
      for (int y = patch.rect.y_begin; y < patch.rect.y_end; ++y) {
        const IdealArc arc = patch.Scanline(y);
        for (int x = arc.x_begin; x < arc.x_end; ++x) {
          covered[y * 320 + x] += 1;
          const Vec3 q = arc.At(arc.Parameter(x));
          const std::optional<Vec3> exact = IdealPosition(camera.k, map, x + 0.5, y + 0.5);
          ASSERT_TRUE(exact) << camera.name;
          // The error is compared as an angle times the focal length: in pixels at the image
          // centre.
          const Mat3 inverse = camera.k.InverseMatrix();
          const Vec3 a = (inverse * q).normalized(), b = (inverse * *exact).normalized();
          EXPECT_LE((a - b).norm() * camera.k.fx_px, 1.2 * IdealPixels::kTolerance_px)
              << camera.name << " " << x << " " << y;
        }
      }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 320 * 240) << camera.name;
    // The patches must be few, because patches of a few pixels save no time. Small images with
    // strong distortion, as in this test, need the most patches for their size.
    EXPECT_LE(pixels.patches().size(), 320u * 240 / 25) << camera.name;
  }
}

TEST(IdealPixels, PixelsBeyondTheFoldHaveNoPatch) {
  // x (1 - 0.3 x^2) is at most 0.70: no ray arrives farther than 0.70 focal lengths from the
  // principal point.
  const Intrinsics k{200, 200, 160, 120, 0, 320, 240, {DistortionModel::kRadialTangential, {-0.3}}};
  const DistortionMap map(k.distortion);
  const IdealPixels pixels(k);
  std::vector<bool> covered(320 * 240);
  for (const IdealPatch& patch : pixels.patches())
    for (int y = patch.rect.y_begin; y < patch.rect.y_end; ++y)
      for (int x = patch.rect.x_begin; x < patch.rect.x_end; ++x) covered[y * 320 + x] = true;
  size_t missing = 0;
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < 320; ++x) {
      EXPECT_EQ(covered[y * 320 + x], IdealPosition(k, map, x + 0.5, y + 0.5).has_value())
          << x << " " << y;
      missing += covered[y * 320 + x] ? 0 : 1;
    }
  EXPECT_GT(missing, 5000u);
  EXPECT_LT(missing, 60000u);
}

TEST(IdealPixels, AFormLiesBetweenItsValuesAtTheControlPoints) {
  for (const Case& camera : Cameras()) {
    const IdealPixels pixels(camera.k);
    const PixelForm form(0.3, -0.7, 12);
    for (const IdealPatch& patch : pixels.patches()) {
      double low = Value(form, patch.control[0][0]), high = low;
      for (const auto& row : patch.control)
        for (const Vec3& control : row) {
          low = std::min(low, Value(form, control));
          high = std::max(high, Value(form, control));
        }
      for (int y = patch.rect.y_begin; y < patch.rect.y_end; y += 7) {
        const IdealArc arc = patch.Scanline(y);
        for (int x = arc.x_begin; x < arc.x_end; ++x) {
          const double value = Value(form, arc.At(arc.Parameter(x)));
          EXPECT_GE(value, low - 1e-9);
          EXPECT_LE(value, high + 1e-9);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lf
