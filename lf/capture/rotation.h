// Rotations as files have them: rounded to a few digits. For the readers of
// calibrations.
#pragma once

#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// A matrix that is a rotation to 1e-12 bit for bit, else the rotation nearest to it.
// kInput, without the place: entries that are not finite, a determinant of zero or below (a
// mirrored axis), axes that miss right angles or unit length by more than `tolerance`, which is at
// most 1e-2.
Result<Mat3> NearestRotation(const Mat3& matrix, double tolerance);

}  // namespace lf
