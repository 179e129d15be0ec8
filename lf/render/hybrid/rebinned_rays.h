// SPDX-License-Identifier: Apache-2.0
// The rebinned rays of the frames of one pass. Keeps the rays that the frames need, LF image after
// LF image, and interpolates the frames from these rays (thesis 4.3.2, 4.3.3).
//
// The rays that a finished frame needs are known from calibrations (lens_gaps.h). By default, all
// of them are kept if there is room, otherwise only rays at edges in the LF images (thesis
// Eq. 4.4). A preview (a picture of an unfinished frame, asked_pixels.h) needs more rays: while few
// LF images are collected, rebinned rays at edges fill the lens points that no collected ray covers
// yet. The queries of previews (the rays to be interpolated, rebinning/frame_queries.h) are updated
// before the LF images at ranks 64, 256, 1024, ... of the order: cells that no query can use any
// more are dropped, and rebinning stops once no frame needs more rays. All of this depends on
// ranks, not on time, so that the kept rays depend neither on the number of threads nor on
// interruptions.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/film/develop/develop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/rebinning/coverage_map.h"
#include "lf/rebinning/ray_map.h"
#include "lf/rebinning/rebin_image.h"
#include "lf/rebinning/slab_plan.h"
#include "lf/render/collect/image_consumer.h"
#include "lf/render/collect/shared_ideal_pixels.h"
#include "lf/render/hybrid/asked_pixels.h"
#include "lf/render/hybrid/film_slabs.h"
#include "lf/render/hybrid/lens_gaps.h"

namespace lf {

// A frame that may be completed by rebinned rays. Rebinned rays are made from LF images at all
// ranks of the order, even if the frame collects rays from fewer.
struct RebinnedFrame {
  FrameId id;
  LensGaps gaps;
};

class RebinnedRays : public ImageConsumer {
 public:
  // The light field of `index`, and `pool`, must outlive the object.
  //   slabs     the slabs of the film
  //   frames    the frames of the pass, by ascending ids
  //   collects  true if the frames also collect rays
  RebinnedRays(const ImageIndex& index, const FilmSlabs& slabs, std::vector<RebinnedFrame> frames,
               bool collects, const SelectOptions& select, const RebinSettings& options,
               ThreadPool& pool);
  ~RebinnedRays() override;

  uint32_t ranks_done() const override;
  PixelRect RectOf(LfImageId id, uint32_t rank) const override;
  void Take(std::span<const BatchImage> images, uint32_t rank_end) override;

  // Returns the camera for which LF images to rebin are selected (AskedPixels::camera()). Null if
  // neither the finished frame nor its previews need rebinned rays.
  //   frame  index in the constructor's `frames`
  const RenderCamera* ReachedCamera(size_t frame) const;

  // Returns the interpolated part of a frame when exactly the LF images at ranks before `rank`
  // are collected.
  //   frame  index in the constructor's `frames`
  Completion Complete(size_t frame, uint32_t rank);

  // The state from which an interrupted render resumes: a map of rays for each section.
  // Consecutive frames that need rebinned rays and have the same slab form a section. All sections
  // get equal parts of the memory.
  size_t section_count() const { return sections_.size(); }
  const RayMap& map(size_t section) const;
  // Largest number of cells of a section.
  size_t max_cells_per_section() const { return max_cells_per_section_; }
  uint32_t ranks_done(size_t section) const;
  // Replaces the map of a section, for example by one that an earlier run saved.
  //   map  made for max_cells_per_section() cells; has the rays of all LF images at ranks before
  //        ranks_done
  void Restore(size_t section, RayMap map, uint32_t ranks_done);

  // BytesOf() returns an upper bound of the memory for max_cells cells: their map, the rays of one
  // frame that are made from them, the rays that wait to be inserted, and the coverage maps.
  static constexpr size_t kBytesPerCell = 100;
  static constexpr size_t kLeastCells = 1000;
  static size_t BytesOf(size_t max_cells) {
    return max_cells * kBytesPerCell + (size_t{192} << 20);
  }

  // Expectations of a section before LF images are taken; estimated from calibrations.
  struct Expected {
    size_t frame_count = 0;      // number of frames that need rays when they are finished
    double pixel_count = 0;      // number of LF pixels whose rays these frames need
    size_t allocated_cells = 0;  // number of cells for which memory is allocated at once
  };
  Expected expected(size_t section) const;
  // Sorts the cells of all sections, which the next Complete() of a section would do.
  void SortCells();

  struct Facts {
    size_t section_count = 0;
    size_t cell_count = 0;
    uint64_t looked_at = 0;  // number of LF pixels that the coverage maps cover
    double cpu_s = 0;        // CPU time to make cells from LF pixels, sum of all threads
    // true: all rays that finished frames need are kept; false: only those at edges in the LF
    // images
    bool keeps_all = false;
    bool is_full = false;        // true: cells were dropped because a section had too many cells
    bool is_too_coarse = false;  // true: a cell got more rays than it can hold
  };
  Facts facts() const;
  // Returns one line of text for each section, which describes its slab and coverage for the log.
  std::vector<std::string> Describe() const;

 private:
  struct Section;
  // A frame that needs rebinned rays and has a slab.
  struct AskingFrame {
    const RebinnedFrame* frame;
    size_t slab;
    AskedPixels asked;
  };
  const AskingFrame* Asking(size_t frame) const;
  void MakeSections(const FilmSlabs& slabs);
  PixelRect RectOf(LfImageId id, uint32_t rank, size_t begin, size_t end) const;
  void MakeMaps(const ImageIndex& index);
  void Begin(uint32_t phase, Section& section);
  SplatFrame SplatBy(std::span<const FrameRay> rays, const FrameQueries& queries,
                     const LensPointSets& points, const PointShares* shares) const;
  SplatFrame SplatOf(const Section& section, const FrameQueries& queries) const;
  SplatFrame SplatOfPoints(const Section& section, const FrameQueries& queries) const;
  void Rebin(std::span<const BatchImage> images, Section& section);

  const LightField& light_field_;
  const std::vector<RebinnedFrame> frames_;
  const SelectOptions select_;
  const RebinSettings options_;
  ThreadPool& pool_;
  const std::vector<uint16_t> stored_values_;
  std::vector<AskingFrame> asking_;  // by ascending ids
  std::vector<std::unique_ptr<Section>> sections_;
  SharedIdealPixels ideal_pixels_;
  bool keeps_all_ = false;
  size_t max_cells_per_section_ = 1;
  uint64_t looked_at_ = 0;
  std::atomic<int64_t> cpu_ns_ = 0;
};

}  // namespace lf
