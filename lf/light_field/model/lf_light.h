// SPDX-License-Identifier: Apache-2.0
// The pixels of an LF image as light for display and for programs that know no radiance encoding.
#pragma once

#include "lf/core/image.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// Returns linear light [height][width][3] of the pixels `pixels.rect`, which must be RGB: with sRGB
// primaries, white balanced, 1 is display white. Masked pixels are `masked`. Opacities are left
// out.
Image<float> LightOf(const LfPixels& pixels, const RadianceEncoding& encoding, float masked);

}  // namespace lf
