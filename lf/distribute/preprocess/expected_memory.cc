// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/expected_memory.h"

#include <algorithm>

namespace lf {

size_t ExpectedBytes(const RenderMemory& memory, const LightField& light_field,
                     const ReadImages& read, bool collects, bool prefilters,
                     const RebinCost* cost) {
  // A filtered copy is smaller than its LF image where elements are wider than LF pixels.
  constexpr double kCopyShare = 0.5;
  constexpr double kPlannedShare = 0.125;
  // Share of two batches that is in memory at once while rays are collected. Measured with the
  // film of blender-shop in bench/forecasts.py.
  constexpr double kHeldShare = 0.625;
  const MemoryPlan& plan = memory.plan;
  uint64_t most_pixels = 1;
  for (const Intrinsics& k : light_field.intrinsics)
    most_pixels = std::max(most_pixels, static_cast<uint64_t>(k.width_px) * k.height_px);
  const double mean_bytes =
      static_cast<double>(plan.image_bytes) * static_cast<double>(read.pixel_count) /
      static_cast<double>(std::max<size_t>(1, read.count)) / static_cast<double>(most_pixels);
  const size_t in_batch = std::min(plan.batch_image_count, read.count);
  const size_t in_two = std::min(2 * plan.batch_image_count, read.count);
  double batches_bytes = static_cast<double>(in_two) * mean_bytes;
  if (collects && prefilters)
    batches_bytes += kCopyShare * static_cast<double>(in_batch) * mean_bytes;
  if (collects)
    batches_bytes =
        kHeldShare * batches_bytes + kPlannedShare * static_cast<double>(plan.plan_bytes);
  const size_t fixed_bytes = plan.total_bytes - plan.batches_bytes;
  const auto needed = static_cast<size_t>(batches_bytes);
  if (cost == nullptr) return fixed_bytes + std::min(needed, plan.batches_bytes);
  return fixed_bytes + std::min(cost->map_bytes + std::max(needed, cost->frame_bytes),
                                plan.batches_bytes + memory.rebin_bytes);
}

}  // namespace lf
