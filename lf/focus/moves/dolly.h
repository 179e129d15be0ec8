// SPDX-License-Identifier: Apache-2.0
// Lets the camera of an example path move straight ahead.
#pragma once

#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns a movement straight ahead through Shot::start. It is a tenth of the focus distance long,
// or as far as two limits allow, in each direction. First, the rays of the picture's borders, which
// diverge, must come through LF cameras: through a lens that lies within the captured positions
// (Shot::reach); or, along an axis along which these extend less far than half of the lens, as at
// a track, through the inner half of the lens. Second, LF cameras must have recorded 99 % of the
// first and the last frame; an element counts as recorded as in MakeOrbit().
CameraMove MakeDolly(const LightField& light_field, const Shot& shot);

}  // namespace lf
