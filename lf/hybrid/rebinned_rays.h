// The rebinned rays of the frames of one pass: which are kept, LF image after LF image, and what
// the frames make of them (thesis 4.3.2, 4.3.3).
//
// What a finished frame will ask for is known from calibrations (lens_gaps.h). Of that all rays are
// kept if there is room for them, else those at edges (Eq. 4.4). Early pictures ask for more: where
// few LF images are collected yet, rebinned rays, at edges, are a preview. What these ask for is
// looked at anew before the LF images at places 64, 256, 1024, ... : cells that no query can use
// any more are dropped, and once all that is left is covered, nothing is rebinned. All of this
// depends on places, not on time: the same rays are kept for any number of threads, however often
// the work was interrupted.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/collector/image_taker.h"
#include "lf/core/parallel.h"
#include "lf/hybrid/asked_pixels.h"
#include "lf/hybrid/film_slabs.h"
#include "lf/hybrid/lens_gaps.h"
#include "lf/rebinning/coverage_map.h"
#include "lf/rebinning/ray_map.h"
#include "lf/rebinning/rebin_image.h"
#include "lf/rebinning/slab_plan.h"
#include "lf/sequence/develop.h"

namespace lf {

// Which of the rays that finished frames ask for are kept.
enum class KeptRays {
  kAuto,  // all, if they fit in max_cells; else kEdges
  kAll,
  kEdges,  // by Eq. 4.4
};
// "auto", "all", "edges"
const char* NameOf(KeptRays kept);

struct RebinPassOptions {
  RebinOptions rebin;
  KeptRays kept = KeptRays::kAuto;
  Previews previews = Previews::kAuto;
  QueryOptions query;
  // Whether rays are told apart in each frame's own lens plane and focus plane, or in those of the
  // slab: then only with one set of lens points.
  bool reparameterise = true;
  // By queries of a k-d tree: the judge, far slower. Not 0: of the `nearest` rays.
  bool is_reference = false;
  size_t nearest = 0;
  SlabChoices slab;
  CoverageOptions coverage;
  size_t max_cells = 0;  // of all sections
};

class RebinnedRays : public ImageTaker {
 public:
  // All that is referred to must outlive it.
  //   slabs     of the film
  //   frames    of the pass, ascending
  //   gaps      one per frame, and so are places, which the frame takes
  //   collects  whether the frames collect, too
  RebinnedRays(const ImageIndex& index, const FilmSlabs& slabs, std::span<const FrameId> frames,
               std::vector<LensGaps> gaps, std::span<const PlaceRange> places, bool collects,
               const SelectOptions& select, const RebinPassOptions& options, ThreadPool& pool);
  ~RebinnedRays() override;

  uint32_t places_done() const override;
  PixelRect RectOf(LfImageId id, uint32_t place) const override;
  void Take(std::span<const BatchImage> images, uint32_t place_end) override;

  // Lenses that hold all rays that are asked for, of frames that ever ask, to select LF images by;
  // and which frames these are.
  std::vector<RenderCamera> ReachedCameras() const;
  const std::vector<size_t>& asking_frames() const { return asking_; }

  // What is interpolated of a frame when the LF images at places before this one are collected.
  Completion Complete(size_t frame, uint32_t place);

  // What is kept, so that a render that was interrupted goes on: consecutive frames have a section,
  // with a map, a slab and a part of the memory of their own.
  size_t section_count() const { return sections_.size(); }
  const RayMap& map(size_t section) const;
  size_t max_cells_per_section() const { return max_cells_per_section_; }
  uint32_t places_done(size_t section) const;
  //   map  of max_cells_per_section(), with all LF images before the place
  void Restore(size_t section, RayMap map, uint32_t places_done);

  // What so many cells take at most, their map, and what of them is made for one frame; and beside
  // them what waits for the map, and the coverage maps.
  static constexpr size_t kBytesPerCell = 100;
  static constexpr size_t kLeastCells = 1000;
  static size_t BytesOf(size_t max_cells) {
    return max_cells * kBytesPerCell + (size_t{192} << 20);
  }

  struct Facts {
    size_t section_count = 0;
    size_t cell_count = 0;
    uint64_t looked_at = 0;  // LF pixels
    double cpu_s = 0;
    bool keeps_all = false;      // rays that finished frames ask for, not those at edges alone
    bool is_full = false;        // cells were dropped, as there were more than max_cells
    bool is_too_coarse = false;  // RayMap::is_too_coarse() of one
  };
  Facts facts() const;
  // The slabs and what is kept of rays, in a sentence each.
  std::vector<std::string> Describe() const;

 private:
  struct Section;
  void MakeSections(const FilmSlabs& slabs, std::span<const FrameId> frames);
  PixelRect RectOf(LfImageId id, uint32_t place, size_t begin, size_t end) const;
  void MakeMaps(const ImageIndex& index, std::span<const PlaceRange> places);
  void Begin(uint32_t phase, Section& section);
  SplatFrame SplatBy(std::span<const FrameRay> rays, const FrameQueries& queries,
                     const LensPointSets& points, const PointShares* shares) const;
  SplatFrame SplatOf(const Section& section, const FrameQueries& queries) const;
  SplatFrame SplatOfPoints(const Section& section, const FrameQueries& queries) const;
  void FindIdealPixels(std::span<const BatchImage> images);
  void Rebin(std::span<const BatchImage> images, Section& section);

  const LightField& light_field_;
  const std::vector<LensGaps> gaps_;
  const SelectOptions select_;
  const RebinPassOptions options_;
  ThreadPool& pool_;
  const std::vector<uint16_t> stored_values_;
  std::vector<size_t> asking_;      // frames that LF cameras could answer
  std::vector<AskedPixels> asked_;  // by these
  std::vector<std::unique_ptr<Section>> sections_;
  std::map<uint32_t, std::shared_ptr<const IdealPixels>> ideal_pixels_;  // by index of intrinsics
  bool keeps_all_ = false;
  size_t max_cells_per_section_ = 1;
  uint64_t looked_at_ = 0;
  std::atomic<int64_t> cpu_ns_ = 0;
};

}  // namespace lf
