// SPDX-License-Identifier: Apache-2.0
// The thin lens (thesis 2.2.5, 2.2.6): pure formulas, lengths in world units.
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// Returns the distance behind the lens at which a point on the focus plane is imaged sharply.
//
//   1/f = 1/g + 1/b                                     (thesis Eq. 2.8)
//
// focal_length_w    f > 0
// focus_distance_w  g, from the lens to the focus plane; must exceed f
// Returns b; f if g is infinite. kInput if f <= 0, or if g <= f: the lens then forms no real image.
Result<double> ImageDistance(double focal_length_w, double focus_distance_w);

// Returns the f-number N = f / d (thesis Eq. 2.11); infinity for a pinhole.
double FNumber(double focal_length_w, double aperture_diameter_w);

// Returns the diameter of the blur of a point at depth z for a lens of diameter d that is focused
// at depth g, in world units on the focus plane:  d |z - g| / z. Multiplied by the number of
// elements per world unit at the focus plane (fx / g), it is the circle of confusion in elements
// (thesis Eq. 2.9, seen from the object side).
double BlurOnFocusPlane(double aperture_diameter_w, double focus_distance_w, double depth_w);

// Returns the range of depths at which the blur of a point, BlurOnFocusPlane(), is at most
// blur_limit_w. The formula is exact; thesis Eq. 2.10 approximates it for g >> f. The far end is
// infinity if the blur limit is at least the aperture diameter, that is, if the focus distance is
// at least the hyperfocal distance. The range is [0, infinity) for a pinhole.
DepthRange DepthOfField(double aperture_diameter_w, double focus_distance_w, double blur_limit_w);

}  // namespace lf
