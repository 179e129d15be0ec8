// SPDX-License-Identifier: Apache-2.0
// Opacity and trust of the pixels of an LF image in one picture, so that guarded plates
// (film/plate/sensor_plate.h) collect both at once.
#pragma once

#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Moves the opacities and the trust into pixels that kernels can collect with the rays of `pixels`:
// R is the opacity (kOpaque if there are no opacities), G and B are the trust, in the values of
// opacities. Masked pixels stay masked. `pixels` must be RGB.
LfPixels TakeOpacityAndTrust(LfPixels* pixels);

}  // namespace lf
