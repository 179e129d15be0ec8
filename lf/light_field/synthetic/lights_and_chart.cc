// SPDX-License-Identifier: Apache-2.0
// Describes the two scenes for measurements, `lights` and `chart`. Both are composed for a camera
// at z = -1 m that looks along +z.
#include <array>
#include <cmath>

#include "lf/light_field/synthetic/built_in_scenes.h"

namespace lf {
namespace {

constexpr double kCameraZ = -1;
constexpr double kFocalPx = 480;  // focal length of the recommended capture, in pixels

// Returns the point that the middle camera sees at (x, y) pixels from the centre of its picture.
Vec3 PointAt(double x_px, double y_px, double depth_w) {
  return {x_px / kFocalPx * depth_w, y_px / kFocalPx * depth_w, kCameraZ + depth_w};
}

// Returns a matte print. The room is equally white on all sides, so that radiance equals
// reflectance.
Material Print(PatternKind pattern, double scale_w) {
  Material print;
  print.colour = Rgb::Constant(0.8);
  print.second_colour = Rgb::Constant(0.03);
  print.pattern = {pattern, scale_w, 1};
  return print;
}

void Hang(SceneDescription& scene, const Material& material, const Vec3& centre,
          const Vec3& half_right_w, const Vec3& half_up_w) {
  scene.materials.push_back(material);
  scene.panels.push_back(
      {centre, half_right_w, half_up_w, false, static_cast<uint32_t>(scene.materials.size() - 1)});
}

}  // namespace

// Far rows are at the top and near rows at the bottom; red is on the left and blue on the right, so
// that a mirrored or rotated picture is noticed at once.
SceneDescription DescribeLights() {
  constexpr std::array kDepths = {3.0, 2.0, 1.4, 1.0, 0.75, 0.6, 0.5};
  constexpr double kSigmaPx = 1.2;
  SceneDescription scene;
  for (size_t row = 0; row < kDepths.size(); ++row)
    for (int column = -5; column <= 5; ++column) {
      const double right = (column + 5) / 10.0;
      const Vec3 place = PointAt(40 * column, 40 * (static_cast<double>(row) - 3), kDepths[row]);
      scene.glows.push_back({place, kSigmaPx * std::sqrt(2.0) * kDepths[row] / kFocalPx,
                             20 * Rgb(1 - 0.9 * right, 0.3, 0.1 + 0.9 * right)});
    }
  return scene;
}

SceneDescription DescribeChart() {
  SceneDescription scene;
  scene.room.floor = scene.room.ceiling = Rgb::Constant(0.02);
  scene.room.ambient = Rgb::Ones();
  Hang(scene, Print(PatternKind::kStar, 0.15), {0, 0, 0}, {0.16, 0, 0}, {0, -0.16, 0});
  Hang(scene, Print(PatternKind::kLetters, 0.03), {-0.21, 0, -0.3}, {0.085, 0, 0}, {0, -0.1, 0});
  Hang(scene, Print(PatternKind::kLetters, 0.06), {0.42, 0, 0.4}, {0.17, 0, 0}, {0, -0.2, 0});
  Hang(scene, Print(PatternKind::kBars, 0.005), {0, -0.22, 0}, {0.3, 0, 0.2}, {0, -0.035, 0});
  Hang(scene, Print(PatternKind::kChecker, 0.04), {0, 0.21, 0}, {0.32, 0, 0}, {0, 0, 0.4});
  return scene;
}

}  // namespace lf
