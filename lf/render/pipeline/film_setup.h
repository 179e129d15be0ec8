// SPDX-License-Identifier: Apache-2.0
// Holds what the frames of a film share while they are rendered: the light field, its LF images,
// the options, and the plan of the memory.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/collect/memory_plan.h"
#include "lf/render/hybrid/film_slabs.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

class FilmSetup {
 public:
  // Resolves the options, opens the LF images, plans the memory, and tells the store how much of it
  // is for reference images. With kBilinear, also makes room
  // in the radiance encoding for values below black (with prefilters also for values above white),
  // and measures the footprint of LF pixels (MeasureFootprint()) if the filter needs it and neither
  // the options nor the light field state it. The pool must outlive the object.
  //   frames  some frames of the package, ascending; empty: all of its frames
  //   store   loads the LF images instead of the store that OpenStore() would open, if not null
  // kUsage: the options are not compatible with each other or with the package.
  // kInput: the packed store cannot be opened, or lacks pixels that a frame needs (CheckKept() of
  // render/needs/frame_needs.h).
  // kOutput: memory_bytes does not suffice (PlanRenderMemory()), or MeasureFootprint() could not
  // read an LF image because the machine lacks something.
  static Result<std::unique_ptr<FilmSetup>> Make(Package package, const FilmSettings& film,
                                                 const WorkSettings& work,
                                                 std::vector<FrameId> frames, ThreadPool& pool,
                                                 std::unique_ptr<LfImageStore> store = nullptr);

  const Package& package() const { return package_; }
  const LightField& light_field() const { return package_.light_field; }
  const CameraPath& path() const { return package_.path; }
  const FilmSettings& film() const { return film_; }
  const WorkSettings& work() const { return work_; }
  const std::vector<FrameId>& frames() const { return frames_; }
  ThreadPool& pool() const { return pool_; }
  const ImageIndex& index() const { return index_; }
  const LfImageStore& store() const { return *store_; }
  const MemoryPlan& plan() const { return plan_; }
  // Returns what the reference images of predicted LF images take.
  ReferenceNeed References() const;
  // Returns what reference images take, what of it `plan()` keeps, and how each LF image is decoded
  // about once; "" if it is so already, or if no LF image is predicted.
  std::string ReferenceNote() const;
  // Sets the memory for reference images that are kept, instead of plan().reference_bytes. Not
  // while LF images are loaded.
  void LimitReferences(size_t most_bytes) { store_->LimitReferences(most_bytes); }
  // True if the plates are guarded, as a densified light field allows (Resolved()).
  bool is_guarded() const { return film_.guard; }
  // The largest number of cells of rebinned rays; 0 if the mode has none.
  size_t max_cells() const { return max_cells_; }
  SelectOptions Select() const;
  // Options that decide which LF images frames need.
  NeedsOptions Needs() const;

  // Plans the slabs of the whole film, so that a frame has the same slab in any package and in any
  // part of the film. Does nothing if the mode has no rebinned rays, or if the slabs are planned
  // already. kInterrupted: WorkSettings::stop is set.
  Result<void> PlanSlabs();
  // Must be called only after PlanSlabs(), in a mode with rebinned rays.
  const FilmSlabs& slabs() const { return *slabs_; }

 private:
  FilmSetup(Package package, const FilmSettings& film, const WorkSettings& work,
            std::vector<FrameId> frames, ThreadPool& pool);
  Result<void> CheckStore() const;
  Result<void> FindFootprint();
  Result<void> PlanMemory();

  const Package package_;
  FilmSettings film_;
  const WorkSettings work_;
  const std::vector<FrameId> frames_;
  ThreadPool& pool_;
  const ImageIndex index_;
  std::unique_ptr<LfImageStore> store_;
  MemoryPlan plan_;
  size_t enough_bytes_ = 0;  // RenderMemory::enough_bytes
  size_t max_cells_ = 0;
  std::optional<FilmSlabs> slabs_;
};

}  // namespace lf
