// SPDX-License-Identifier: Apache-2.0
// Finds out how bright and how dark the views of a light field can be, so that their files keep all
// of their light.
#pragma once

#include "lf/light_field/model/radiance.h"

namespace lf {

// Returns the encoding of floats that hold light as LightOf() returns it. It keeps the whole range
// of this light: with white balance and the colours of the display, it may be brighter than
// recorded.max_radiance, and darker than black. It is the recorded encoding if that has neither.
//   recorded  encoding of the LF images
RadianceEncoding EncodingOfLight(const RadianceEncoding& recorded);

}  // namespace lf
