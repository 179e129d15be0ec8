// SPDX-License-Identifier: Apache-2.0
// Warns of masks that lie beside the images of a light field without being used.
#pragma once

#include <optional>

#include "lf/core/shell_word.h"
#include "lf/import/check/capture_report.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the warning "unused-masks" if LF images without a mask have one in a folder near them, or
// beside them in instant-ngp's form (light_field/model/masks_beside.h). Its message contains the
// call of lfimport that uses them, if there is one.
//   import_again  repeats the call with options added
std::optional<CaptureWarning> WarnOfUnusedMasks(const LightField& light_field,
                                                const CallAgain& import_again);

}  // namespace lf
