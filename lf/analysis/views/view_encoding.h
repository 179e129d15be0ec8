// SPDX-License-Identifier: Apache-2.0
// Finds out how bright and how dark the views of a light field can be, so that their files keep all
// of their light.
#pragma once

#include "lf/light_field/model/radiance.h"

namespace lf {

// Returns the encoding of floats that hold light as LightOf() returns it. It keeps the whole range
// of this light: with white balance and the colours of the display, light may be brighter than
// recorded.max_radiance, and darker than black. The range is the recorded one if the recorded
// encoding has neither white balance nor a colour matrix.
//   recorded  encoding of the LF images
RadianceEncoding EncodingOfLight(const RadianceEncoding& recorded);

}  // namespace lf
