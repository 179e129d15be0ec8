// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <string>

#include "lf/core/random.h"

namespace lf {
namespace {

Mat3 Rotation(uint64_t seed) {
  const Eigen::Quaterniond q(RandomUnit(seed, 0, 0) - 0.5, RandomUnit(seed, 0, 1) - 0.5,
                             RandomUnit(seed, 0, 2) - 0.5, RandomUnit(seed, 0, 3) - 0.5);
  return q.normalized().toRotationMatrix();
}

std::string ErrorOf(const Mat3& matrix, double tolerance) {
  const Result<Mat3> result = NearestRotation(matrix, tolerance);
  return result ? "" : result.error().message;
}

TEST(NearestRotation, ARotationIsTakenBitForBit) {
  for (uint64_t seed = 0; seed < 100; ++seed)
    EXPECT_EQ(*NearestRotation(Rotation(seed), 1e-4), Rotation(seed));
}

// The expected rotation is U V^T of the singular value decomposition.
TEST(NearestRotation, RoundedOnesBecomeTheNearest) {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    Mat3 rounded = Rotation(seed);
    for (int i = 0; i < 9; ++i) rounded(i) = std::round(rounded(i) * 1e3) / 1e3;
    const Eigen::JacobiSVD<Mat3> svd(rounded, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat3 expected = svd.matrixU() * svd.matrixV().transpose();
    EXPECT_LT((*NearestRotation(rounded, 1e-2) - expected).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(NearestRotation, WhatIsNoneIsRefusedWithItsReason) {
  Mat3 matrix = Mat3::Identity();
  matrix(0, 1) = 2e-4;
  EXPECT_NE(ErrorOf(matrix, 1e-4).find("sheared"), std::string::npos);
  EXPECT_EQ(ErrorOf(matrix, 1e-3), "");
  EXPECT_NE(ErrorOf(1.001 * Mat3::Identity(), 1e-4).find("unit length"), std::string::npos);
  EXPECT_NE(ErrorOf(-Mat3::Identity(), 1e-4).find("mirrored"), std::string::npos);
  EXPECT_NE(ErrorOf(Mat3::Zero(), 1e-2), "");
  matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(ErrorOf(matrix, 1e-4).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace lf
