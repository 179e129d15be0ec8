// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/expected_memory.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

// A plan for LF images of 100 x 10 pixels and 8000 bytes: 1000 bytes besides two batches of 16.
class ExpectedMemoryTest : public ::testing::Test {
 protected:
  ExpectedMemoryTest() {
    field_.intrinsics = {{100, 100, 50, 5, 0, 100, 10}};
    memory_.plan.batch_image_count = 16;
    memory_.plan.plan_bytes = 4000;
    memory_.plan.image_bytes = 8000;
    memory_.plan.batches_bytes = 3 * 16 * 8000 + 4000;
    memory_.plan.total_bytes = 1000 + memory_.plan.batches_bytes;
    memory_.rebin_bytes = 5000000;
  }
  LightField field_;
  RenderMemory memory_;
};

TEST_F(ExpectedMemoryTest, LfImagesCountWithThePixelsThatAreRead) {
  // Ten LF images are less than a batch, and half of their pixels are read.
  EXPECT_EQ(ExpectedBytes(memory_, field_, {10, 5000}, true, false, nullptr),
            1000u + 10 * 4000 * 5 / 8 + 4000 / 8);
  EXPECT_EQ(ExpectedBytes(memory_, field_, {10, 5000}, true, true, nullptr),
            1000u + (10 * 4000 + 10 * 4000 / 2) * 5 / 8 + 4000 / 8);
  EXPECT_EQ(ExpectedBytes(memory_, field_, {500, 500000}, true, true, nullptr),
            1000u + (32 * 8000 + 16 * 8000 / 2) * 5 / 8 + 4000 / 8);
  EXPECT_LE(ExpectedBytes(memory_, field_, {500, 500000}, true, true, nullptr),
            memory_.plan.total_bytes);
}

TEST_F(ExpectedMemoryTest, RebinnedRaysTakeWhatTheyFillButNotMoreThanTheirShare) {
  RebinCost cost;
  cost.map_bytes = 30000;
  cost.frame_bytes = 70000;
  EXPECT_EQ(ExpectedBytes(memory_, field_, {10, 5000}, false, true, &cost), 1000u + 30000 + 70000);
  cost.frame_bytes = 20000;
  EXPECT_EQ(ExpectedBytes(memory_, field_, {10, 5000}, false, true, &cost),
            1000u + 30000 + 10 * 4000);
  cost.map_bytes = 90000000;
  EXPECT_EQ(ExpectedBytes(memory_, field_, {10, 5000}, false, true, &cost),
            memory_.plan.total_bytes + memory_.rebin_bytes);
}

TEST_F(ExpectedMemoryTest, NoLfImageTakesNothing) {
  EXPECT_EQ(ExpectedBytes(memory_, field_, {}, false, true, nullptr), 1000u);
}

}  // namespace
}  // namespace lf
