// SPDX-License-Identifier: Apache-2.0
// Sorts the rays of one LF image into the cells of a slab (thesis 4.3.2), and decides which rays
// are kept.
//
// The ray of a pixel is kept if RebinCoverage::whole covers it, or if a random number in [0, 1) is
// below the pixel's p (probability_map.h). The random number depends only on seed, LF image and
// pixel, so the kept rays depend neither on the number of threads, nor on the order of the LF
// images, nor on the part of an LF image that is read.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/rebinning/coverage_map.h"
#include "lf/rebinning/probability_map.h"
#include "lf/rebinning/ray_map.h"
#include "lf/rebinning/rebin_options.h"

namespace lf {

// Returns the largest distance, in LF pixels, between a pixel and another pixel that its p or the
// colour of its ray depends on.
int PixelsAround(const RebinOptions& options, bool is_mosaic);

// Rays of some LF images, sorted into the shards of a RayMap. Clear() keeps the memory for reuse.
struct BinnedRays {
  std::array<std::vector<BinnedRay>, RayMap::kShards> kept;
  // Rays that are not kept; empty unless RebinOptions::averages_others is true.
  std::array<std::vector<BinnedRay>, RayMap::kShards> others;
  uint64_t looked_at = 0;  // number of covered LF pixels

  void Clear();
};

// The maps that decide which squares of kBlock x kBlock pixels of an LF image are covered. A square
// is covered if one of the maps covers the ray through its middle.
struct RebinCoverage {
  static constexpr int kBlock = 8;
  const CoverageMap* whole = nullptr;  // all rays of the squares that it covers are kept
  // Rays of the squares that only these maps cover are kept with the probability p of Eq. 4.4. A
  // null map covers nothing.
  std::array<const CoverageMap*, 2> by_edges = {};
};

// Adds to rays->kept those rays of the pixels of `rect` that are covered, have a cell of the slab,
// and are kept. Adds to rays->others those that are not kept, if options.averages_others is true. A
// ray has the three colours of its pixel. In a mosaic, the two colours that a pixel did not record
// are the means of its neighbours that did.
//   pixels         must hold `rect`, and should hold PixelsAround() more pixels on each side that
//                  is not a border of the LF image; without these, p and the colours near the
//                  borders of `rect` differ a little
//   stored_values  StoredValueTable() of the light field
//   ideal_pixels   the IdealPixels of lf_camera's intrinsics; must be null if, and only if,
//                  lf_camera has no lens distortion
//   coverage       null: all pixels are covered, and kept with the probability of Eq. 4.4
//   map            rays for whose cells map.MayHold() is false are left out
void RebinImage(const Slab& slab, const PinholeCamera& lf_camera, LfImageId id,
                const LfPixels& pixels, const PixelRect& rect,
                const std::vector<uint16_t>& stored_values, const IdealPixels* ideal_pixels,
                const RebinOptions& options, const RebinCoverage* coverage, const RayMap& map,
                BinnedRays* rays);

// Returns the approximate share of the pixels of `rect` that the map covers. Tests only the middles
// of squares of RebinCoverage::kBlock pixels a side, and ignores lens distortion.
double CoveredShare(const Slab& slab, const PinholeCamera& lf_camera, const PixelRect& rect,
                    const CoverageMap& map);

// Adds the kept rays to the map by all threads, trims the map, and then adds the other rays to the
// cells that are left. If there are other rays, the result depends on which LF images are added in
// the same call, but not on their order.
//   cpu_ns  the CPU time that all threads spend on adding rays is added to it; may be null
void InsertRays(const std::vector<BinnedRays>& rays, ThreadPool& pool, RayMap* map,
                std::atomic<int64_t>* cpu_ns = nullptr);

}  // namespace lf
