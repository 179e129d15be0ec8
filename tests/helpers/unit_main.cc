// SPDX-License-Identifier: Apache-2.0
// The main function of all unit test programs. It differs from GoogleTest's own in one point: a run
// in which a test was skipped and none failed ends with 77, which ctest shows as skipped.
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (RUN_ALL_TESTS() != 0) return 1;
  constexpr int kSkipped = 77;
  return testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? kSkipped : 0;
}
