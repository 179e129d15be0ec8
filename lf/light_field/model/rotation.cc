// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/rotation.h"

#include <fmt/format.h>

#include <Eigen/LU>

namespace lf {
namespace {

constexpr double kExact = 1e-12;

// Returns the largest deviation of the columns from right angles and unit length.
double Skew(const Mat3& axes) {
  return (axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff();
}

}  // namespace

Result<Mat3> NearestRotation(const Mat3& matrix, double tolerance) {
  LF_CHECK(tolerance <= 1e-2);
  if (!matrix.allFinite())
    return InputError("holds a number that is not finite: expected a rotation");
  const double determinant = matrix.determinant();
  if (determinant < 0)
    return InputError(
        "is mirrored (its determinant is negative): expected the right-handed axes of a rotation");
  const double skew = Skew(matrix);
  if (!(skew <= tolerance))
    return InputError(
        fmt::format("is sheared or scaled, not a rotation: its axes deviate from right angles and "
                    "unit length by "
                    "{:.2g}; expected at most {:g}",
                    skew, tolerance));
  if (skew <= kExact) return matrix;
  // The orthogonal factor of the polar decomposition, by Newton's iteration (Higham 1986). For a
  // matrix within the tolerance, three steps reach machine precision; the fourth is a reserve.
  Mat3 axes = matrix;
  for (int i = 0; i < 4; ++i) axes = 0.5 * (axes + axes.inverse().transpose()).eval();
  return axes;
}

}  // namespace lf
