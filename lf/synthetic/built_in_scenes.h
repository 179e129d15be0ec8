// The scenes that come with the program, each with the capture it was composed for.
//
// Lengths are metres. y points down; the origin is the middle of what the cameras look at.
//
// `still-life`  Glass, mirrors and marbles on a dark wooden table, strings of small lights far
//               behind. Depths in front of the middle camera: marbles 0.50 to 1.2, the large
//               spheres 0.66 to 1.05, lights 1.9 to 2.6.
// `lights`      Lights alone, on black: seven rows of them at depths 0.5, 0.6, 0.75, 1, 1.4, 2, 3.
// `chart`       Test charts: a Siemens star facing the cameras at 1.0, digits at 0.7 (left) and
//               1.4 (right), bars slanted from 0.8 to 1.2 (top), and a checkered board lying at the
//               bottom, from 0.6 to 1.4 (for tilted focus planes).
//
// How dense a capture has to be. Focused at depth g, a light at depth z appears moved by
//     step_px = focal_length_px * spacing_w * |1/g - 1/z|
// from one camera to the next, so that its bokeh is a sum of dots step_px apart. A lamp (Glow) of
// radius r is a Gaussian dot of sigma_px = focal_length_px * r / (sqrt(2) z); the sum ripples by
// 2 exp(-2 (pi sigma_px / step_px)^2): 1.4 % at sigma = step / 2, 8 % at 0.4, invisible beyond.
#pragma once

#include <span>
#include <string_view>

#include "lf/camera/pinhole.h"
#include "lf/synthetic/rig.h"
#include "lf/synthetic/scene_description.h"

namespace lf {

struct BuiltInScene {
  std::string_view name;
  std::string_view summary;
  SceneDescription (*describe)();
  // The recommended capture, used where the call says nothing else. A capture of another size
  // keeps the horizontal field of view.
  RigOptions rig;
  int width_px = 480;
  int height_px = 320;
  double focal_length_per_width = 1;  // fx / width
  int samples = 4;                    // Photograph()
  double max_radiance = 1;            // no light is brighter; RadianceEncoding::max_radiance
};

std::span<const BuiltInScene> BuiltInScenes();

// Null for an unknown name.
const BuiltInScene* FindBuiltInScene(std::string_view name);

// Square pixels, central principal point.
Intrinsics IntrinsicsFor(const BuiltInScene& scene, int width_px, int height_px);

SceneDescription DescribeStillLife();
SceneDescription DescribeLights();
SceneDescription DescribeChart();

}  // namespace lf
