// SPDX-License-Identifier: Apache-2.0
// Rotation matrices from files, where they are rounded to a few digits. Used by the readers of
// calibrations.
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// Returns `matrix` unchanged, bit for bit, if it is a rotation within 1e-12, and otherwise the
// rotation nearest to it.
// kInput for entries that are not finite; for a determinant of 0 or less (a mirrored axis); for
// axes that deviate from right angles or unit length by more than `tolerance`, which is at most
// 1e-2. The message does not name the place in the file; the caller adds it.
Result<Mat3> NearestRotation(const Mat3& matrix, double tolerance);

}  // namespace lf
