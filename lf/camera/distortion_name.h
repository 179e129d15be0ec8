// SPDX-License-Identifier: Apache-2.0
// Names of the models of lens distortion, for people and reports.
#pragma once

#include "lf/camera/distortion.h"

namespace lf {

// Returns a name such as "radial-tangential"; "pinhole" for kNone.
const char* NameOf(DistortionModel model);

}  // namespace lf
