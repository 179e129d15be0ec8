// SPDX-License-Identifier: Apache-2.0
// Finds out from LF images whether an LF pixel shows the mean light of its area or the light of a
// point.
#pragma once

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Looks at the pixels at sharp edges in the middle of up to three LF images, whose choice depends
// only on the number of LF images and on which of them can be read. If pixels show points, hardly
// any of them has a value between those of the two sides of its edge; if they show areas, most
// have. In 10 scenes and captures, the share of pixels with such a value was 0.09 - 0.14 where
// pixels show points, 0.54 - 0.63 in renders whose pixels show areas, and 0.79 - 1.0 in
// photographs, whose lenses blur. Returns kArea if fewer than 200 sharp edges are found (500 in
// mosaics), or the LF
// images are broken. kOutput: the machine lacks something, such as memory; a guess instead would
// change the bits of frames. In mosaics, recorded green pixels along diagonals are looked at.
//   store  must load mosaics as RGB
Result<PixelFootprint> MeasureFootprint(const LightField& light_field, const LfImageStore& store);

// Returns the footprint that the light field states, or else what MeasureFootprint() finds.
Result<PixelFootprint> FootprintOf(const LightField& light_field, const LfImageStore& store);

}  // namespace lf
