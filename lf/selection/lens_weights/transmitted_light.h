// SPDX-License-Identifier: Apache-2.0
// The light that parts of an opening with a transmission let through.
#pragma once

#include "lf/camera/aperture.h"
#include "lf/camera/transmission.h"
#include "lf/selection/lens_weights/convex_polygon.h"

namespace lf {

// Returns the integral of the transmission, from 0 to 1, over a polygon in the lens plane, in
// squared world units. Exact except for rounding: every place of the picture is a parallelogram of
// one value. Takes about 0.2 microseconds for each place that the polygon touches.
//   aperture  of the lens that the transmission is in; radius_w > 0
double TransmittedLight(const Transmission& transmission, const Aperture& aperture,
                        const ConvexPolygon& polygon);

}  // namespace lf
