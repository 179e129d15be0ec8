// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/render_memory.h"

#include <gtest/gtest.h>

#include "lf/render/hybrid/rebinned_rays.h"

namespace lf {
namespace {

constexpr size_t kMiB = size_t{1} << 20;

LightField FieldOfThousand() {
  LightField field;
  field.intrinsics = {{1000, 1000, 480, 320, 0, 960, 640}};
  field.cameras.resize(1000);
  field.image_names.resize(1000);
  return field;
}

Result<RenderMemory> PlanOf(size_t memory_mib, RenderMode mode, size_t max_cells,
                            uint64_t reference_mib) {
  return PlanRenderMemory(memory_mib * kMiB, mode, RayInterpolation::kCells, max_cells,
                          FieldOfThousand(), Estimator::kNearest, 480, 320, 10, 2, 0, false, 1,
                          nullptr, {reference_mib * kMiB, false});
}

// The memory that is named keeps all reference images beside the rebinned rays, and less does not.
TEST(RenderMemory, NamesTheMemoryThatKeepsAllReferenceImages) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kHybrid, RenderMode::kRebin})
    for (const size_t max_cells : {size_t{0}, RebinnedRays::kLeastCells}) {
      const RenderMemory few = PlanOf(1500, mode, max_cells, 900).value();
      EXPECT_LT(few.plan.reference_bytes, 900 * kMiB) << NameOf(mode);
      const size_t enough_mib = few.enough_bytes / kMiB + 1;
      EXPECT_EQ(PlanOf(enough_mib, mode, max_cells, 900)->plan.reference_bytes, 900 * kMiB)
          << NameOf(mode) << " " << max_cells;
      EXPECT_LT(PlanOf(enough_mib - 5, mode, max_cells, 900)->plan.reference_bytes, 900 * kMiB)
          << NameOf(mode) << " " << max_cells;
    }
  EXPECT_EQ(PlanOf(1500, RenderMode::kHybrid, 0, 0)->enough_bytes, 0u);
}

// Rebinned rays have the same share with and without reference images, because which rays are kept
// depends on it.
TEST(RenderMemory, ReferenceImagesTakeNothingFromRebinnedRays) {
  for (const RenderMode mode : {RenderMode::kHybrid, RenderMode::kRebin})
    EXPECT_EQ(PlanOf(1500, mode, 0, 900)->max_cells, PlanOf(1500, mode, 0, 0)->max_cells);
}

}  // namespace
}  // namespace lf
