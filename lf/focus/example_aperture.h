// SPDX-License-Identifier: Apache-2.0
// Chooses the aperture of an example path. Internal to example_path.cc.
#pragma once

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/focus/example_focus.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Diameter, as a multiple of the spacing of the LF cameras, below which an aperture holds few LF
// cameras beside the one at its middle.
inline constexpr double kLeastSpacings = 2.5;

struct ExampleAperture {
  double spacings = 0;  // diameter of the aperture, as a multiple of the spacing of the LF cameras
  std::string reason;
  std::string copies = {};  // if the aperture holds one LF camera: what a wider one would show
  // Diameter of the smallest aperture that blurs: the smallest with LF cameras at kFewestCameras
  // positions that see the focus. Infinite if there are fewer.
  double least_spacings = 0;
};

// Fewest LF cameras in a lens that is more than a pinhole: fewer show copies instead of a blur.
inline constexpr size_t kFewestCameras = 6;

// Largest diameter of a lens, as a share of the focus distance: 14 degrees, seen from the focus.
// The widest lenses of photography reach 11 degrees (f/2.8 at life size), and half as much in a
// portrait. A wider lens looks around what it films: highlights and occlusions differ from one side
// of the lens to the other, and the picture is that of no camera.
inline constexpr double kWidestLens = 0.25;

// Returns the aperture for a focus. A point away from the focus plane appears as copies instead of
// as a blur; the distance between two copies is CopiesApart_px()
// (light_field/model/capture_geometry.h), which lfimport forecasts for the capture. Here it is the
// distance that three quarters of the textured places of the LF image do not exceed. Places where
// neighbouring LF images agree on no depth count as infinitely far apart, because places with large
// disparities are those that do not agree; if they alone close the lens, the reason says that it is
// not sure. If the image has hardly any texture, a point at 3/4 of the focus distance is assumed,
// as lfimport does.
//
// Copies up to 3 px apart are invisible: the lens spans eight LF cameras. If they are farther
// apart, the lens is narrower, so that there are fewer of them. The lens holds a single LF camera
// if they are more than 16 px apart; if the focus may be wrong; or if the smallest aperture that
// blurs is wider than kWidestLens.
ExampleAperture ChooseAperture(const LightField& light_field, const PinholeCamera& camera,
                               const ExampleFocus& focus, double spacing_w);

inline constexpr double kWidestDensified = 0.08;

// Returns the aperture for a focus if virtual LF images will be put into the lens, so that it blurs
// without copies however far apart the LF cameras are. What is farthest out of focus, but for a
// tenth of the textured places, is blurred over a 25th of the picture's width. The lens is not
// wider than the distance between LF cameras, because virtual LF images are right near them, nor
// than kWidestLens. It is ChooseAperture() if that is wider, or if the focus may be wrong.
//   frame  of the picture
ExampleAperture ChooseDensifiedAperture(const LightField& light_field, const PinholeCamera& camera,
                                        const Intrinsics& frame, const ExampleFocus& focus,
                                        double spacing_w);

}  // namespace lf
