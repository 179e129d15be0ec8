// SPDX-License-Identifier: Apache-2.0
// Removes LF images from a light field.
#pragma once

#include <cstddef>
#include <span>

#include "lf/light_field/model/light_field.h"

namespace lf {

// Removes all LF images but those with the given indices, which must be ascending.
void KeepImages(std::span<const size_t> kept, LightField* light_field);

// Returns the light field without its virtual LF images. Does not adapt LfCamera::brighter, which
// is not set in a packed store, the only place of virtual LF images.
LightField RecordedPart(LightField light_field);

}  // namespace lf
