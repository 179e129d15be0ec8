// SPDX-License-Identifier: Apache-2.0
#include "lf/core/geometry.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

using Mat4 = Eigen::Matrix4d;
using Vec4 = Eigen::Vector4d;

// Returns the matrix M of thesis Eq. 2.3, entry by entry.
Mat4 MatrixOfTheThesis(const RigidTransform& transform) {
  Mat4 m = Mat4::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m(row, column) = transform.rotation(row, column);
    m(row, 3) = transform.translation[row];
  }
  m(3, 3) = 1;
  return m;
}

// Returns (x / w, y / w, z / w) of a homogeneous vector (thesis Eq. 2.1, 2.2).
Vec3 Inhomogeneous(const Vec4& v) { return Vec3(v[0] / v[3], v[1] / v[3], v[2] / v[3]); }

RigidTransform RandomTransform(RandomSequence& random) {
  const auto number = [&random] { return random.Uniform(-2, 2); };
  const Vec3 axis(number(), number(), number());
  const double angle_rad = number();
  const Vec3 translation(number(), number(), number());
  return {Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), translation};
}

TEST(RigidTransform, ActsAsTheMatrixOfTheThesisOnHomogeneousVectors) {
  RandomSequence random(1);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform transform = RandomTransform(random);
    const Vec3 point(random.Uniform(-5, 5), random.Uniform(-5, 5), random.Uniform(-5, 5));
    // Every multiple of the augmented vector is the same point.
    for (const double w : {1.0, -0.5, 3.0}) {
      const Vec4 homogeneous = w * Vec4(point.x(), point.y(), point.z(), 1);
      const Vec3 expected = Inhomogeneous(MatrixOfTheThesis(transform) * homogeneous);
      EXPECT_LT((transform * point - expected).norm(), 1e-12);
    }
  }
}

// A quarter turn about z maps the x axis to y and the y axis to -x. The translation follows.
TEST(RigidTransform, TurnsFirstAndMovesAfterwards) {
  RigidTransform transform;
  transform.rotation << 0, -1, 0,  //
      1, 0, 0,                     //
      0, 0, 1;
  transform.translation = Vec3(10, 20, 30);
  EXPECT_EQ(transform * Vec3(1, 2, 3), Vec3(8, 21, 33));
  EXPECT_EQ(transform.Inverse() * Vec3(8, 21, 33), Vec3(1, 2, 3));
}

TEST(RigidTransform, ProductsAndInversesAreThoseOfTheMatrices) {
  RandomSequence random(2);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform c_from_b = RandomTransform(random), b_from_a = RandomTransform(random);
    const Mat4 product = MatrixOfTheThesis(c_from_b) * MatrixOfTheThesis(b_from_a);
    EXPECT_LT((MatrixOfTheThesis(c_from_b * b_from_a) - product).norm(), 1e-12);
    const Mat4 inverse = MatrixOfTheThesis(b_from_a).inverse();
    EXPECT_LT((MatrixOfTheThesis(b_from_a.Inverse()) - inverse).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace lf
