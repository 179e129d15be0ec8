// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/forecast_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostOfLimit = 0.98;

// Returns the change of 1 / depth, from that of the focus plane, at which the copies of an edge are
// kMostOfLimit * kDoubleEdge_px elements apart; infinite for a single LF camera.
double StepPerW(const RenderCamera& camera, const FrameDensity& density) {
  const double elements = camera.pinhole.intrinsics.fx_px * density.camera_distance_w;
  return elements > 0 ? kMostOfLimit * kDoubleEdge_px / elements : kInfinity;
}

double DepthOf(double per_w) { return per_w > 0 ? 1 / per_w : kInfinity; }

std::optional<DepthRange> FreeFocus(const PreprocessReport& report, const CameraPath& path) {
  DepthRange focus{0, kInfinity};
  for (const FrameForecast& frame : report.frames) {
    const double step = StepPerW(path.Camera(frame.frame), frame.density);
    if (std::isinf(step)) continue;
    const DepthRange& depths = frame.density.depths;
    focus.near_w = std::max(focus.near_w, 1 / (1 / depths.far_w + step));
    focus.far_w = std::min(focus.far_w, DepthOf(1 / depths.near_w - step));
  }
  return focus.near_w > 0 && focus.near_w < focus.far_w ? std::optional(focus) : std::nullopt;
}

// Rounds up or down to three digits, with a tolerance of a fiftieth of the last digit.
double Rounded(double value, bool up) {
  if (!(value > 0) || std::isinf(value)) return value;
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  constexpr double kSlack = 0.02;
  return (up ? std::ceil(value / unit - kSlack) : std::floor(value / unit + kSlack)) * unit;
}

}  // namespace

ForecastAdvice AdviceOf(const PreprocessReport& report, const CameraPath& path,
                        bool are_depths_known) {
  ForecastAdvice advice;
  if (are_depths_known) advice.focus = FreeFocus(report, path);
  const FrameForecast& worst =
      *std::max_element(report.frames.begin(), report.frames.end(),
                        [](const FrameForecast& a, const FrameForecast& b) {
                          return a.density.MostDisplacement_px() < b.density.MostDisplacement_px();
                        });
  const RenderCamera& camera = path.Camera(worst.frame);
  const double step = StepPerW(camera, worst.density), focus_per_w = 1 / camera.focus_distance_w;
  advice.depths = {1 / (focus_per_w + step), DepthOf(focus_per_w - step)};
  const Intrinsics& plate = camera.pinhole.intrinsics;
  const double scale = std::min(
      1.0, kMostOfLimit * kDoubleEdge_px / std::max(worst.density.MostDisplacement_px(), 1e-9));
  advice.width_px = std::max(1, static_cast<int>(plate.width_px * scale));
  advice.height_px = std::max(1, static_cast<int>(plate.height_px * scale));
  advice.largest_aperture_w = kInfinity;
  for (const FrameForecast& frame : report.frames)
    advice.largest_aperture_w =
        std::min(advice.largest_aperture_w, frame.density.coverage.fitting_diameter_w);
  return advice;
}

std::string LengthText(double length_w, double unit_m) {
  const double length_m = length_w * unit_m;
  if (!std::isfinite(length_m)) return "-";
  if (length_m == 0) return "0";
  const double size = std::abs(length_m);
  if (size < 1e-3) return fmt::format("{:.3g} um", length_m * 1e6);
  if (size < 1) return fmt::format("{:.3g} mm", length_m * 1e3);
  return size < 1e3 ? fmt::format("{:.3g} m", length_m) : fmt::format("{:.3g} km", length_m / 1e3);
}

std::string RangeText(const DepthRange& range, double unit_m) {
  const std::string near = LengthText(Rounded(range.near_w * unit_m, true), 1);
  if (std::isinf(range.far_w)) return fmt::format("farther than {}", near);
  return fmt::format("between {} and {}", near,
                     LengthText(Rounded(range.far_w * unit_m, false), 1));
}

std::string AtMostText(double length_w, double unit_m) {
  return LengthText(Rounded(length_w * unit_m, false), 1);
}

}  // namespace lf
