// Figures for a path that take the warnings of a forecast away.
#pragma once

#include <optional>
#include <string>

#include "lf/path/camera_path.h"
#include "lf/preprocess/preprocess.h"

namespace lf {

// Elements that an eye takes for one edge.
inline constexpr double kDoubleEdge_px = 2;

// Lengths are world units. Each figure keeps 2 % away from the limit, so that it may be rounded.
struct ForecastAdvice {
  // Focus distances with which no frame shows the scene with double edges; far_w may be infinite.
  // None if no focus does that for all frames, or if the depths of the scene are not known.
  std::optional<DepthRange> focus;
  // Depths without double edges in the frame that has most of them, along its axis, and the largest
  // size without them. far_w may be infinite.
  DepthRange depths;
  int width_px = 0, height_px = 0;
  // Diameter of the largest lens that is within the capture in every frame; 0 if none is.
  double largest_aperture_w = 0;
};

ForecastAdvice AdviceOf(const PreprocessReport& report, const CameraPath& path,
                        bool are_depths_known);

// "31.2 mm", "2.05 m", "1.2 km"
std::string LengthText(double length_w, double unit_m);
// "between 1.2 m and 3 m", "from 1.2 m on", rounded inwards
std::string RangeText(const DepthRange& range, double unit_m);
// "30 mm", rounded down
std::string AtMostText(double length_w, double unit_m);

}  // namespace lf
