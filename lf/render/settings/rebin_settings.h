// SPDX-License-Identifier: Apache-2.0
// The settings of rebinned rays: which rays are kept, and how frames are interpolated from them
// (doc/rebinning.md).
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/rebinning/rebin_options.h"

namespace lf {

// Says which of the rays that finished frames need are kept.
enum class KeptRays {
  kAuto,   // kAll if, by an estimate, these rays fit in max_cells; otherwise kEdges
  kAll,    // all rays that finished frames need
  kEdges,  // rays at edges in the LF images, by thesis Eq. 4.4
};
// Returns "auto", "all" or "edges".
const char* NameOf(KeptRays kept);

// Says between what rays are interpolated (render/settings/interpolation.h).
enum class RayInterpolation {
  kAuto,    // InterpolationOf() chooses
  kPixels,  // kept pixels of each LF image; frames are collected from them
  kCells,   // cells of a slab, by Gaussian kernels
};
// Returns "auto", "pixels" or "cells".
const char* NameOf(RayInterpolation interpolation);

// Says which frames have previews. A preview is a picture of an unfinished frame. Rebinned rays are
// kept for it, in addition to those that the finished frame needs. Only a frame that also collects
// rays can have previews.
enum class Previews {
  kAuto,  // a frame has previews if it collects more than kPreviewedFrom LF images
  kOn,
  kOff,
};
// Returns "auto", "on" or "off".
const char* NameOf(Previews previews);
inline constexpr size_t kPreviewedFrom = 256;

// How a frame is interpolated between cells.
struct QueryOptions {
  // Least sigma of the kernels (rebinning/ray_query.h) in the lens plane, in distances between LF
  // cameras.
  double sigma_st = 0.5;
  // Sigma of the kernels on the plate, in elements, or in LF pixels if these are larger; at most 8
  // elements are used.
  double sigma_uv = 0.35;
  // Number of lens points in a set; 0: 8 to 256, chosen so that their kernels overlap.
  int lens_point_count = 0;
  int lens_sets = 1;  // k of LensPointSets (rebinning/lens_points.h): there are k x k sets
  uint64_t seed = 0;  // seed of the positions of the lens points
};

// The members query, reparameterise, is_reference, nearest, slab and coverage, and
// averages_others and colour_sigma_px of `rebin`, are used for cells alone.
struct RebinSettings {
  RayInterpolation interpolation = RayInterpolation::kAuto;
  RebinOptions rebin;
  KeptRays kept = KeptRays::kAuto;
  Previews previews = Previews::kAuto;
  QueryOptions query;
  // If true, distances between rays are measured on each frame's lens plane and focus plane. If
  // false, they are measured on the planes of the slab; query.lens_sets must then be 1.
  bool reparameterise = true;
  // If true, the slower SplatReference() (rebinning/splat.h) interpolates the rays. If `nearest` is
  // not 0, it interpolates between this number of nearest rays, instead of the rays within reach.
  bool is_reference = false;
  size_t nearest = 0;
  SlabChoices slab;
  CoverageOptions coverage;
  static constexpr size_t kLeastCells = 1000;
  // Largest number of cells in the maps of all sections together, at least kLeastCells; 0 only
  // before PlanRenderMemory() has chosen a number.
  size_t max_cells = 0;
  // True: memory for the expected cells is allocated at once. False: memory grows with the cells,
  // because only a few LF images are taken (render/hybrid/rebin_cost.h).
  bool allocates = true;
};

}  // namespace lf
