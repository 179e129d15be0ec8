// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/propose_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/focus/example_aperture.h"
#include "lf/focus/example_focus.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr size_t kNearCameras = 400;  // LF cameras that tell how far a capture reaches

}  // namespace

std::optional<ProposedLens> ProposeLens(const LightField& light_field, const PinholeCamera& camera,
                                        double focus_distance_w) {
  if (light_field.size() < 2 || !std::isfinite(focus_distance_w) || !(focus_distance_w > 0))
    return std::nullopt;
  const double spacing_w = MedianSpacing(light_field);
  if (!(spacing_w > 0)) return std::nullopt;
  ExampleFocus focus;
  focus.distance_w = focus_distance_w;
  ExampleAperture aperture = ChooseAperture(light_field, camera, focus, spacing_w);
  ProposedLens lens;
  lens.needs_densifying = aperture.spacings < kLeastSpacings;
  if (lens.needs_densifying)
    aperture = ChooseDensifiedAperture(light_field, camera, camera.intrinsics, focus, spacing_w);
  lens.diameter_w = aperture.spacings * spacing_w;
  lens.reason = aperture.reason;
  const Reach reach = CaptureReach(light_field, camera, kNearCameras);
  const double most_w =
      std::max(aperture.least_spacings * spacing_w, 2 * std::max(reach.right_w, reach.up_w));
  if (lens.diameter_w > most_w) {
    lens.diameter_w = most_w;
    lens.reason = fmt::format("{:.2g} spacings of LF cameras, about as wide as they reach",
                              most_w / spacing_w);
  }
  return lens;
}

}  // namespace lf
