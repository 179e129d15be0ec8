// SPDX-License-Identifier: Apache-2.0
// Compares positions and directions in tests.
#pragma once

#include <gtest/gtest.h>

#include "lf/core/geometry.h"

namespace lf {

inline void ExpectNear(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR((a - b).norm(), 0, 1e-12) << a.transpose() << " and " << b.transpose();
}

}  // namespace lf
