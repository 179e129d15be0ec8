// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/film_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "lf/core/median.h"

namespace lf {
namespace {

// Returns the number for one point; none if the frame does not show it.
std::optional<double> OfPoint(const RenderCamera& frame, const PixelRect& elements,
                              const Vec3& point) {
  const Vec3 at = frame.pinhole.cam_from_world * point;
  if (!(at.z() > 0)) return std::nullopt;
  const Vec3 element = frame.pinhole.intrinsics.Matrix() * at / at.z();
  if (!(element.x() >= elements.x_begin && element.x() < elements.x_end &&
        element.y() >= elements.y_begin && element.y() < elements.y_end))
    return std::nullopt;
  const std::optional<Vec3> focus = FocusPointOfElement(frame, element.x(), element.y());
  // A tilted plane that the ray never meets is in focus at infinity.
  const double inverse_focus = focus ? 1 / (frame.pinhole.cam_from_world * *focus).z() : 0;
  return frame.pinhole.intrinsics.fx_px * std::abs(1 / at.z() - inverse_focus);
}

std::optional<double> OfFrame(const RenderCamera& frame,
                              std::span<const std::vector<Vec3>> points) {
  constexpr double kMost = 0.97, kNearlyAll = 0.995, kFarther = 4, kAlone = 1.1;
  constexpr size_t kLeastPoints = 50, kLeastImages = 4;
  const PixelRect elements = ElementsOf(frame);
  std::vector<double> of_most, of_nearly_all;  // [LF image]
  for (const std::vector<Vec3>& of_image : points) {
    std::vector<double> found;
    for (const Vec3& point : of_image)
      if (const std::optional<double> number = OfPoint(frame, elements, point))
        found.push_back(*number);
    if (found.size() < kLeastPoints) continue;
    std::sort(found.begin(), found.end());
    const auto quantile = [&](double share) {
      return found[static_cast<size_t>(share * static_cast<double>(found.size() - 1))];
    };
    of_most.push_back(quantile(kMost));
    of_nearly_all.push_back(quantile(kNearlyAll));
  }
  if (of_most.empty()) return std::nullopt;
  std::sort(of_nearly_all.begin(), of_nearly_all.end(), std::greater<>());
  double nearly_all = of_nearly_all[0];
  if (of_nearly_all.size() >= kLeastImages)
    nearly_all = std::min(nearly_all, kAlone * of_nearly_all[1]);
  return std::max(Median(std::move(of_most)), nearly_all / kFarther);
}

}  // namespace

std::optional<double> CopiesPerDistance(std::span<const RenderCamera> frames,
                                        std::span<const std::vector<Vec3>> points) {
  constexpr size_t kMostFrames = 50;
  const size_t step = (frames.size() + kMostFrames - 1) / kMostFrames;
  std::optional<double> most;
  for (size_t f = 0; f < frames.size(); f += step)
    if (const std::optional<double> number = OfFrame(frames[f], points))
      most = std::max(most.value_or(0), *number);
  return most;
}

}  // namespace lf
