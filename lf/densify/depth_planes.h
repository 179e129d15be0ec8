// SPDX-License-Identifier: Apache-2.0
// The depth planes of the LF images of a plan: searched, made to agree with each other, and stored.
// Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/densify_work.h"
#include "lf/densify/depth_cache.h"
#include "lf/densify/depth_plane.h"
#include "lf/densify/watched_loop.h"
#include "lf/densify/working_images.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

class DepthPlanes {
 public:
  // Calls body(i) for every i in [0, count) on all threads; as ForEachWatched().
  using Loop = std::function<Result<void>(DensifyStep step, size_t count,
                                          const std::function<Result<void>(size_t)>& body)>;

  // All must outlive this object.
  DepthPlanes(const LightField& light_field, const DensifyPlan& plan, WorkingImages& images,
              PackedStoreWriter& writer, const LfImageKeys& keys, DepthCache& cache,
              InterruptFlag interrupted)
      : light_field_(light_field),
        plan_(plan),
        images_(images),
        writer_(writer),
        keys_(keys),
        cache_(cache),
        interrupted_(interrupted),
        planes_(light_field.size()) {}

  // Searches the depths of plan.swept, except for planes that the cache or the store has from an
  // earlier run. Keeps them in the cache, or else in the store.
  Result<void> Search(const Loop& loop);
  // Returns how many planes Search() will probably search.
  size_t MissingCount() const;
  // Replaces depths on which neighbours do not agree, twice.
  Result<void> MakeAgree(const Loop& loop);
  // Stores the planes of plan.stored.
  Result<void> Store(const Loop& loop) const;

  // Returns the plane of the working image of an LF image of plan.swept.
  const DepthPlane& Of(uint32_t id) const { return planes_[id]; }

  // Figures of Search() and MakeAgree().
  struct Facts {
    size_t cached = 0;  // number of planes that the cache had
    double cpu_s = 0;   // CPU time of the search
    double searched_pixels = 0;
    double agreeing_share = 0;  // share of the pixels on whose depth two neighbours agree
  };
  const Facts& facts() const { return facts_; }

 private:
  PinholeCamera CameraOf(uint32_t id) const {
    return WorkingCamera(light_field_.Camera(LfImageId{id}), plan_.divisor);
  }
  Result<void> CheckNotInterrupted() const;
  DepthCache::Entry EntryOf(uint32_t id) const {
    return keys_.PlaneOf(id, plan_.compare_with[id], plan_.range, plan_.planes, plan_.divisor);
  }
  Result<void> SearchOne(uint32_t id);
  Result<DepthPlane> Searched(uint32_t id);
  Result<DepthPlane> Agreeing(uint32_t id, double* agreeing_count, double* shown_count) const;

  const LightField& light_field_;
  const DensifyPlan& plan_;
  WorkingImages& images_;
  PackedStoreWriter& writer_;
  const LfImageKeys& keys_;
  DepthCache& cache_;
  const InterruptFlag interrupted_;
  std::vector<DepthPlane> planes_;  // [LF image]; empty for those that are not searched

  std::mutex mutex_;  // guards facts_ while threads run
  Facts facts_;
};

}  // namespace lf
