// Rotations as files have them: rounded to a few digits. For the readers of calibrations.
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// Returns a matrix that is a rotation within 1e-12 unchanged, bit for bit, and otherwise the
// rotation nearest to it.
// kInput, without the place in the file: entries that are not finite; a determinant of 0 or less (a
// mirrored axis); axes that miss right angles or unit length by more than `tolerance`, which is at
// most 1e-2.
Result<Mat3> NearestRotation(const Mat3& matrix, double tolerance);

}  // namespace lf
