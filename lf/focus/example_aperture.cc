// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/example_aperture.h"

#include <fmt/format.h>

#include <algorithm>

namespace lf {
namespace {

constexpr double kMostSpacings = 8;  // limit, as kLeastSpacings
// An aperture of this diameter contains only the LF camera at its middle. A wider one could contain
// others, because in captures shaped like rings the hat weights of other LF cameras reach far into
// the lens.
constexpr double kSharpSpacings = 0.001;

}  // namespace

// Returns the aperture for a focus. A point away from the focus plane appears as several ghosts
// instead of as a blur. The distance between two ghosts is the point's displacement between
// neighbouring LF cameras. Ghosts up to kGoodCopies_px apart are invisible. If they are farther
// apart, the lens is made narrower, so that there are fewer of them. If they are more than
// kMostCopies_px apart, or if the focus may be wrong, only a lens that contains a single LF camera
// gives a clear picture.
ExampleAperture ChooseAperture(const ExampleFocus& focus, double fx_px, double spacing_w) {
  constexpr double kGoodCopies_px = 3, kMostCopies_px = 16;
  if (!focus.doubt.empty())
    return {kSharpSpacings,
            "which holds one LF camera, so that the first frame is sharp at any distance"};
  // If the depths are unknown, the nearest point is assumed to be at
  // focus.distance_w / (1 + kUnknownRange).
  constexpr double kUnknownRange = 0.25;
  double range_per_w = kUnknownRange / focus.distance_w;
  if (focus.near_w < focus.far_w)
    range_per_w = std::max(1 / std::min(focus.near_w, focus.distance_w) - 1 / focus.distance_w,
                           1 / focus.distance_w - 1 / std::max(focus.far_w, focus.distance_w));
  const double copies_px = fx_px * spacing_w * range_per_w;
  if (copies_px > kMostCopies_px)
    return {kSharpSpacings,
            fmt::format("which holds one LF camera, because out-of-focus objects would otherwise "
                        "appear as copies up to {:.0f} px apart",
                        copies_px),
            fmt::format("objects out of focus are displaced by up to {:.0f} px from one to the "
                        "next",
                        copies_px)};
  const double spacings = std::clamp(kMostSpacings * kGoodCopies_px / std::max(copies_px, 1e-9),
                                     kLeastSpacings, kMostSpacings);
  return {spacings, fmt::format("{:.2g} spacings of LF cameras, for which copies of out-of-focus "
                                "objects are up to {:.2g} px apart",
                                spacings, copies_px)};
}

}  // namespace lf
