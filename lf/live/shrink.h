// SPDX-License-Identifier: Apache-2.0
// Shrinks LF images to about the size at which a small picture shows them, so that hundreds of them
// fit in memory and each element reads one position of an LF image.
#pragma once

#include "lf/camera/render_camera.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/image_index.h"

namespace lf {

// Returns the light field whose LF images are shrunken: each of their pixels is the mean of a
// square of divisor x divisor LF pixels. Columns and rows that do not fill a square are cut off on
// the right and below. An LF image that is smaller than a square keeps one pixel. Mosaics become
// RGB.
LightField ShrunkField(LightField light_field, int divisor);

// Writes the mean of each square of `pixels`, a whole RGB LF image, to *shrunken, whose memory is
// reused. The mean is rounded to the nearest whole number. It leaves out masked pixels, and is
// masked if fewer than half of the pixels of the square remain. Opacities are averaged likewise.
void Shrink(const LfPixels& pixels, int divisor, LfPixels* shrunken);

// Returns the divisor with which an element of the frame is about one pixel of a shrunken LF image
// wide: the smallest one of 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, ... with which it is at most
// kFinerAtMost pixels wide (collection/prefilter/prefilter.h), because wider elements need several
// samples. Even divisors let JPEG files be decoded at a half, a quarter or an eighth of their size
// (LfImageStore::LoadReduced()). The width is the median in some of the LF cameras around the lens.
//   current  is returned instead if elements are at least half a pixel wide with it, and at most
//            1.3 times kFinerAtMost pixels, so that a moving camera or focus does not change the
//            divisor all the time; 0: none
int DivisorFor(const ImageIndex& index, const RenderCamera& frame, int current);

// Returns the render camera with a plate of another resolution for the same picture. The plate is
// at most side_px elements wide and high, and at least one.
//   width_px  wished width, in elements
RenderCamera WithPlateWidth(const RenderCamera& frame, int width_px, int side_px);

}  // namespace lf
