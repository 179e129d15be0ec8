// SPDX-License-Identifier: Apache-2.0
// The scenes that come with lfsynth, each with the capture for which it was composed.
//
// Lengths are metres. y points down. The origin is the point that the rig faces; in `still-life`,
// it is on the table top, 0.085 below this point.
//
// `still-life`  Glass, mirrors and marbles on a dark wooden table, with strings of small lights far
//               behind. Depths in front of the middle camera: marbles 0.43 to 1.2, the clear glass
//               ball 0.75, the mirror ball 0.90, coloured balls 1.07 to 1.32, lights 2.1 to 2.7.
//               17 x 17 cameras on 48 x 48 mm: an aperture of up to 46 mm. A focus pull from 0.58
//               (amber marble) over 0.75 (glass ball) to 2.3 (lights) shows all of them.
// `lights`      Only lights, on black: seven rows at depths 3, 2, 1.4, 1, 0.75, 0.6, 0.5 from the
//               top, reddish on the left, bluish on the right.
// `chart`       Test charts: a Siemens star facing the cameras at 1.0; digits at 0.7 (left) and 1.4
//               (right); above the star, bars slanted from 0.8 (left) to 1.2 (right); below it, a
//               flat checkered board from 0.6 to 1.4 (for tilted focus planes). Bright parts have
//               radiance 0.8, dark parts 0.03, the background 0.02.
// `foliage`     Test charts at depth 1, digits and a Siemens star, behind leaves at depths 0.44 to
//               0.62, which hide about a quarter of them from each camera. White parts have
//               radiance 0.14, dark parts 0.05, the background 0.04, and leaves at least 0.33 in
//               each colour. A lens of 0.2 sees an element past several leaves, focused on the
//               charts.
//
// How dense a capture must be: in a frame that is focused at depth g, a light at depth z is
// displaced from one camera to the next by
//     step_px = focal_length_px * spacing_w * |1/g - 1/z|
// Its bokeh is therefore a sum of dots that are step_px apart. A Glow of radius r is a
// Gaussian dot of sigma_px = focal_length_px * r / (sqrt(2) z). The sum ripples by
// 2 exp(-2 (pi sigma_px / step_px)^2): 1.4 % at sigma = step / 2, 8 % at 0.4; larger sigma make the
// ripple invisible. Recommended for `still-life`: focal length 540 px, spacing 3 mm, glows of 12.5
// mm radius. For z = 2.3, step is 2.1 px at g = 0.58 and 1.5 px at g = 0.75; sigma is 2.1 px. The
// bokeh of a 46 mm lens is then 32 and 22 px wide, in a picture of 480 px. Estimators that round to
// whole pixels displace the dots by up to half a pixel; sigma is large enough for them.
#pragma once

#include <span>
#include <string_view>

#include "lf/camera/pinhole.h"
#include "lf/light_field/synthetic/rig.h"
#include "lf/light_field/synthetic/scene_description.h"

namespace lf {

struct BuiltInScene {
  std::string_view name;
  std::string_view summary;
  SceneDescription (*describe)();
  // The recommended capture, which is the default. If another image size is chosen, the horizontal
  // field of view stays the same.
  RigOptions rig;
  int width_px = 480;
  int height_px = 320;
  double focal_length_per_width = 1;  // focal length divided by image width
  int samples = 4;                    // rays per pixel at edges of the picture (Photograph())
  double max_radiance = 1;  // upper bound of the radiance; for RadianceEncoding::max_radiance
};

std::span<const BuiltInScene> BuiltInScenes();

// Returns the scene with this name, or null if there is none.
const BuiltInScene* FindBuiltInScene(std::string_view name);

// Returns intrinsics with square pixels and a central principal point.
Intrinsics IntrinsicsFor(const BuiltInScene& scene, int width_px, int height_px);

SceneDescription DescribeStillLife();
SceneDescription DescribeLights();
SceneDescription DescribeChart();
SceneDescription DescribeFoliage();

}  // namespace lf
