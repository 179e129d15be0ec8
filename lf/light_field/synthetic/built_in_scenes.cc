// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/built_in_scenes.h"

#include <array>

namespace lf {
namespace {

std::array<BuiltInScene, 4> MakeScenes() {
  BuiltInScene still_life{"still-life",
                          "glass, mirrors and marbles in front of strings of lights",
                          DescribeStillLife,
                          {}};
  still_life.rig.spacing_w = 0.003;
  still_life.rig.distance_w = 0.8;
  still_life.rig.target_world = {0, -0.085, 0};
  still_life.rig.view_world = {0, 0.04, 0.8};
  still_life.focal_length_per_width = 1.125;
  still_life.max_radiance = 24;

  BuiltInScene lights{"lights", "only lights, at seven depths, on black", DescribeLights, {}};
  lights.max_radiance = 24;

  BuiltInScene chart{"chart", "flat test charts at known depths and slants", DescribeChart, {}};
  chart.samples = 9;

  BuiltInScene foliage{"foliage", "test charts behind sunlit leaves", DescribeFoliage, {}};
  foliage.rig.count = 121;
  foliage.rig.spacing_w = 0.02;
  return {still_life, lights, chart, foliage};
}

}  // namespace

std::span<const BuiltInScene> BuiltInScenes() {
  static const std::array<BuiltInScene, 4> scenes = MakeScenes();
  return scenes;
}

const BuiltInScene* FindBuiltInScene(std::string_view name) {
  for (const BuiltInScene& scene : BuiltInScenes())
    if (scene.name == name) return &scene;
  return nullptr;
}

Intrinsics IntrinsicsFor(const BuiltInScene& scene, int width_px, int height_px) {
  const double focal_px = scene.focal_length_per_width * width_px;
  return {focal_px, focal_px, width_px / 2.0, height_px / 2.0, 0, width_px, height_px};
}

}  // namespace lf
