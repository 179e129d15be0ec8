// SPDX-License-Identifier: Apache-2.0
// Chooses the aperture of an example path. Internal to example_path.cc.
#pragma once

#include <string>

#include "lf/focus/example_focus.h"

namespace lf {

// Diameter, as a multiple of the spacing of the LF cameras, of the smallest aperture that blurs.
inline constexpr double kLeastSpacings = 2.5;

struct ExampleAperture {
  double spacings = 0;  // diameter of the aperture, as a multiple of the spacing of the LF cameras
  std::string reason;
  std::string copies = {};  // if the aperture holds one LF camera: what a wider one would show
};

ExampleAperture ChooseAperture(const ExampleFocus& focus, double fx_px, double spacing_w);

}  // namespace lf
