// SPDX-License-Identifier: Apache-2.0
// Squeezes the picture of a view into a tile of a quilt. Internal to this folder.
#pragma once

#include "lf/core/image.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns the whole picture in another size, which must not exceed its own: a pixel is the mean of
// the light of the area that it covers. Floats are linear light, multiplied by alpha. Integers are
// sRGB display values, of which the second of two and the fourth of four channels is alpha that is
// not multiplied into the others.
StoredImage Squeezed(const StoredImage& view, int width, int height);

}  // namespace lf
