// SPDX-License-Identifier: Apache-2.0
// Finds out about a light field as a whole, and keeps it in a cache: the range of depths, how well
// pairs of LF images agree, and the tests. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/depth_cache.h"
#include "lf/densify/folded_poses.h"
#include "lf/densify/self_test.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

class KeptFindings {
 public:
  // All must outlive this object.
  KeptFindings(const LightField& light_field, const LfImageStore& store, const LfImageKeys& keys,
               DepthCache& cache, ThreadPool& pool)
      : light_field_(light_field), store_(store), keys_(keys), cache_(cache), pool_(pool) {}

  // Returns the result of FindInverseDepths().
  Result<InverseDepths> Range(std::span<const std::vector<uint32_t>> compare_with,
                              const Watch& watch);
  // Returns the result of ComparePairs() for some LF images.
  Result<std::vector<ComparedPair>> Pairs(const DensifyPlan& plan, std::span<const uint32_t> ids,
                                          const Watch& watch);
  // Returns the result of TestByLeavingOut().
  Result<std::vector<LeftOut>> Tests(const DensifyPlan& plan, const Watch& watch);

 private:
  const LightField& light_field_;
  const LfImageStore& store_;
  const LfImageKeys& keys_;
  DepthCache& cache_;
  ThreadPool& pool_;
};

}  // namespace lf
