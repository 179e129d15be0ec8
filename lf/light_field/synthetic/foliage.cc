// SPDX-License-Identifier: Apache-2.0
// Describes the scene `foliage`, composed for a camera at z = -1 m that looks along +z.
#include <cmath>
#include <numbers>

#include "lf/core/random.h"
#include "lf/light_field/synthetic/built_in_scenes.h"

namespace lf {
namespace {

constexpr uint64_t kSeed = 5;
constexpr uint32_t kShades = 8;  // colours of leaves
constexpr uint64_t kLeaves = 180;
constexpr double kNear = -0.56, kFar = -0.38;  // z of the leaves

double Chance(uint64_t leaf, uint64_t what) { return RandomUnit(kSeed, what, leaf); }

double Between(double from, double to, double share) { return from + (to - from) * share; }

// Returns a matte surface. The room is equally white on all sides, so that radiance equals
// reflectance.
Material Matte(const Rgb& colour) {
  Material matte;
  matte.colour = matte.second_colour = colour;
  return matte;
}

// Hangs a chart in the shade: its white has less light than any colour of any leaf.
void HangChart(SceneDescription& scene, PatternKind pattern, double scale_w, const Vec3& centre,
               double half_side_w) {
  Material print = Matte(Rgb::Constant(0.14));
  print.second_colour = Rgb::Constant(0.05);
  print.pattern = {pattern, scale_w, 1};
  scene.materials.push_back(print);
  scene.panels.push_back({centre,
                          {half_side_w, 0, 0},
                          {0, -half_side_w, 0},
                          false,
                          static_cast<uint32_t>(scene.materials.size() - 1)});
}

}  // namespace

SceneDescription DescribeFoliage() {
  SceneDescription scene;
  scene.room.floor = scene.room.ceiling = Rgb::Constant(0.04);
  scene.room.ambient = Rgb::Ones();
  for (uint32_t shade = 0; shade < kShades; ++shade) {
    const double light = static_cast<double>(shade) / (kShades - 1);
    scene.materials.push_back(Matte(
        {Between(0.36, 0.75, light), Between(0.55, 0.95, light), Between(0.33, 0.42, light)}));
  }
  HangChart(scene, PatternKind::kLetters, 0.07, {-0.2, 0, 0}, 0.18);
  HangChart(scene, PatternKind::kStar, 0.17, {0.2, 0, 0}, 0.18);
  for (uint64_t leaf = 0; leaf < kLeaves; ++leaf) {
    // The far leaves are seen over a wider area. The margin is for the LF cameras at the rim.
    const double z = Between(kNear, kFar, Chance(leaf, 0));
    const double half_width_w = 0.5 * (1 + z) + 0.07, half_height_w = half_width_w - 0.16 * (1 + z);
    const double turn_rad = 2 * std::numbers::pi * Chance(leaf, 1);
    const double lean_rad = Between(-0.9, 0.9, Chance(leaf, 2));
    // A sequence of low discrepancy (Roberts 2018): no element is hidden from most cameras.
    const double right = std::fmod(0.7548776662466927 * static_cast<double>(leaf), 1);
    const double down = std::fmod(0.5698402909980532 * static_cast<double>(leaf), 1);
    const double length_w = Between(0.014, 0.026, Chance(leaf, 3));
    const Vec3 along(std::cos(turn_rad), std::sin(turn_rad), 0);
    const Vec3 across(-std::sin(turn_rad) * std::cos(lean_rad),
                      std::cos(turn_rad) * std::cos(lean_rad), std::sin(lean_rad));
    scene.panels.push_back({{Between(-half_width_w, half_width_w, right),
                             Between(-half_height_w, half_height_w, down), z},
                            length_w * along,
                            0.42 * length_w * across,
                            true,
                            static_cast<uint32_t>(RandomBits(kSeed, 6, leaf) % kShades)});
  }
  return scene;
}

}  // namespace lf
