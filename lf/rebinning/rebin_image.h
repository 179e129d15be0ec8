// The rays of one LF image into the cells of a slab (thesis 4.3.2): which of them are kept, and
// where they go.
//
// A pixel's ray is kept where a random number in [0, 1) is below its p (probability_map.h). The
// number depends on seed, LF image and pixel alone: the same rays are kept whatever the threads,
// the order of the images, and the part of them that is read.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/capture/lf_pixels.h"
#include "lf/core/ids.h"
#include "lf/rebinning/coverage_map.h"
#include "lf/rebinning/probability_map.h"
#include "lf/rebinning/ray_map.h"

namespace lf {

struct RebinOptions {
  ProbabilityOptions probability;
  uint64_t seed = 0;
  // Rays that are not kept are added to the cells that are there: less noise, but every pixel's ray
  // must be found (thesis 5.3).
  bool averages_others = false;
  // Colours are smoothed by a Gaussian of so many LF pixels, each channel by what recorded it:
  // against noise, where few rays are kept. At most kMostSigma_px; 0: as recorded.
  double colour_sigma_px = 0;
};
// How far from a pixel what is made of it depends on others.
int PixelsAround(const RebinOptions& options, bool is_mosaic);

// Rays of some LF images, by the shards of a RayMap. Its memory is used again.
struct BinnedRays {
  std::array<std::vector<BinnedRay>, RayMap::kShards> kept;
  std::array<std::vector<BinnedRay>, RayMap::kShards> others;  // empty unless averages_others
  uint64_t looked_at = 0;                                      // LF pixels that are covered

  void Clear();
};

// What is kept of an LF image, square by square of kBlock pixels: where the middle of one is.
struct RebinCoverage {
  static constexpr int kBlock = 8;
  const CoverageMap* whole = nullptr;  // of these rays all
  // Of these some, by Eq. 4.4.
  std::array<const CoverageMap*, 2> by_edges = {};
};

// Adds the rays of the pixels of `rect` that are covered and run through both planes of the slab.
// All three colours are of the pixel; of a mosaic those that it did not record are the means of its
// neighbours'.
//   pixels         at least those of `rect`, and PixelsAround() more where the image has them: else
//                  what is made of those at its borders is a little different
//   stored_values  StoredValueTable() of the light field
//   ideal_pixels   of a camera with lens distortion, else null
//   coverage       null: all is covered, by edges
//   map            rays of cells that it has dropped are left out
void RebinImage(const Slab& slab, const PinholeCamera& lf_camera, LfImageId id,
                const LfPixels& pixels, const PixelRect& rect,
                const std::vector<uint16_t>& stored_values, const IdealPixels* ideal_pixels,
                const RebinOptions& options, const RebinCoverage* coverage, const RayMap& map,
                BinnedRays* rays);

// The share of the pixels of `rect` that are covered by the map, about: by the middles of squares.
double CoveredShare(const Slab& slab, const PinholeCamera& lf_camera, const PixelRect& rect,
                    const CoverageMap& map);

// Puts them into the map, by all threads, and cuts that to its size. Others are added to the cells
// that are there then: with these it matters which LF images are given together, but not their
// order.
//   cpu_ns  the time that it takes is added, of all threads, if given
void InsertRays(const std::vector<BinnedRays>& rays, ThreadPool& pool, RayMap* map,
                std::atomic<int64_t>* cpu_ns = nullptr);

}  // namespace lf
