// SPDX-License-Identifier: Apache-2.0
// Proposes a lens for a camera that has none, from the positions of the LF cameras alone.
#pragma once

#include <optional>
#include <string>

#include "lf/camera/pinhole.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct ProposedLens {
  double diameter_w = 0;
  std::string reason;  // for people, such as "8 spacings of LF cameras; ..."
  // True: the LF cameras are so far apart that the lens shows copies instead of a blur, unless
  // virtual LF images fill it (lf/densify).
  bool needs_densifying = false;
};

// Returns the lens that an example path would have for this camera and focus distance
// (example_path.h), if nothing is known of the scene: no LF image is read, and a quarter of the
// focus distance before the focus is taken for the nearest depth. The lens is no wider than the
// capture, seen from the camera. Returns nullopt if no lens makes sense: the light field has fewer
// than two positions, or the focus distance is not a finite number above 0.
std::optional<ProposedLens> ProposeLens(const LightField& light_field, const PinholeCamera& camera,
                                        double focus_distance_w);

}  // namespace lf
