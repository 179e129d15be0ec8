// SPDX-License-Identifier: Apache-2.0
// How the plate of a light field is developed.
#pragma once

#include "lf/film/develop/develop.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// Returns the options that the encoding of the light field decides: levels, colours, and the values
// of the fourth channel that collection writes. All others are defaults.
DevelopOptions DevelopOptionsOf(const RadianceEncoding& encoding);

}  // namespace lf
