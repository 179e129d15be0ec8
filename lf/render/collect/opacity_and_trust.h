// SPDX-License-Identifier: Apache-2.0
// Opacity and trust of the pixels of an LF image in one picture, so that guarded plates
// (film/plate/sensor_plate.h) collect both at once.
#pragma once

#include <cstdint>

#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Returns the trust that frames show for LfPixels::trust, from 0.25 to 1. It is calibrated: the
// share of elements that differ from a true picture by more than 10 of 255 in R, G or B is about 1
// - T (doc/densify.md, "How far trust can be trusted").
double ShownTrust(uint8_t trust);

// Moves the opacities and the trust into pixels that kernels can collect with the rays of `pixels`:
// R is the opacity (kOpaque if there are no opacities), G and B are ShownTrust(), in the values of
// opacities. Masked pixels stay masked. `pixels` must be RGB.
LfPixels TakeOpacityAndTrust(LfPixels* pixels);

}  // namespace lf
