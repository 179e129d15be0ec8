// SPDX-License-Identifier: Apache-2.0
// Resamples LF images with lens distortion into those that pinhole cameras would have recorded, for
// renderers that know no distortion, such as that of an exported page.
#pragma once

#include <optional>
#include <span>

#include "lf/camera/pinhole.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Returns the intrinsics of one pinhole camera for all of the lenses. Its image shows the largest
// rectangle of directions that every lens sees, at most 60 degrees to each side, and has the focal
// lengths of the first lens, so that the resolution in the middle stays the same. nullopt if this
// image has less than half of the pixels of the first lens, because the lenses see too different
// regions. There must be at least one lens.
std::optional<Intrinsics> CommonPinhole(std::span<const Intrinsics> lenses);

// Writes to *out the pixels that a camera with the intrinsics `pinhole` would have recorded instead
// of the one with the intrinsics `k`, interpolated bilinearly. A pixel is masked if one of the four
// pixels around its position is missing or masked. Opacities are left out.
//   pixels  the whole LF image, as RGB
void Undistort(const LfPixels& pixels, const Intrinsics& k, const Intrinsics& pinhole,
               LfPixels* out);

}  // namespace lf
