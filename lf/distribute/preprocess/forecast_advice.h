// SPDX-License-Identifier: Apache-2.0
// Computes changes of a path that remove the warnings of a forecast.
#pragma once

#include <optional>
#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/distribute/preprocess/preprocess.h"

namespace lf {

// Lengths are in world units. Focus distances, depths and frame sizes are those at which copies of
// an edge are 0.98 kDoubleEdge_px apart, so that these values may be rounded.
struct ForecastAdvice {
  // Focus distances for which no frame shows the scene with double edges; far_w may be infinite.
  // nullopt if there are none, or if the depths of the scene are unknown.
  std::optional<DepthRange> focus;
  // For the frame whose double edges are farthest apart: the depths along its axis at which there
  // are no double edges, and the largest frame size without them. far_w may be infinite.
  DepthRange depths;
  int width_px = 0, height_px = 0;
  // Diameter of the largest lens that is within the capture in every frame; 0 if there is none.
  double largest_aperture_w = 0;
};

ForecastAdvice AdviceOf(const PreprocessReport& report, const CameraPath& path,
                        bool are_depths_known);

// Returns a length with its unit, such as "31.2 mm", "2.05 m" or "1.2 km"; "-" if it is not finite.
std::string LengthText(double length_w, double unit_m);
// Returns a range, such as "between 1.2 m and 3 m" or "farther than 1.2 m", rounded inwards.
std::string RangeText(const DepthRange& range, double unit_m);
// Returns a length, such as "30 mm", rounded down.
std::string AtMostText(double length_w, double unit_m);

}  // namespace lf
