// SPDX-License-Identifier: Apache-2.0
// Makes pictures of LF images for people to look at.
#pragma once

#include <array>
#include <cstdint>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns the sRGB colour, 0 to 255, of 16-bit values v of R, G and B, developed like frames (white
// balance, colour matrix, gain).
std::array<uint8_t, 3> DisplayColour(const RadianceEncoding& encoding, const Vec3& value);

// Returns the LF image as sRGB, [height][width][3], in colours of DisplayColour(). If its longer
// side exceeds max_side_px, it is reduced, and loaded reduced if the store can do so
// (LfImageStore::LoadReduced()): each pixel of the picture is then about the mean of a square.
// Masked pixels are left out of it. A pixel is grey if all pixels of its square are masked.
//   store  must be opened with Mosaics::kToRgb
// Errors: those of LoadReducedWithoutThrowing().
Result<Image<uint8_t>> LfPicture(const LightField& light_field, const LfImageStore& store,
                                 LfImageId id, int max_side_px);

}  // namespace lf
