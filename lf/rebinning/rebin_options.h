// SPDX-License-Identifier: Apache-2.0
// Says how rays are rebinned: which rays are kept, and the planes and cells that they are sorted
// by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "lf/core/geometry.h"

namespace lf {

// How the probability that a ray is kept follows from the image around it (probability_map.h).
struct ProbabilityOptions {
  double sigma_px = 1;         // sigma of the Gaussian, at most kMostSigma_px; 0: no smoothing
  double alpha = 8;            // factor of |LoG|, if black is 0 and white is 1; at most kMostAlpha
  double beta = 0;             // threshold of |LoG|, if black is 0 and white is 1
  double xi = 0.05;            // least p of pixels whose |LoG| reaches beta; in [0, 1]
  double second_sigma_px = 0;  // sigma of another Gaussian, which smooths p; 0: no smoothing
};
inline constexpr double kMostSigma_px = 8;
inline constexpr double kMostAlpha = 255;

// Which rays are kept, and their colours (rebin_image.h).
struct RebinOptions {
  ProbabilityOptions probability;
  uint64_t seed = 0;
  // If true, rays that are not kept are added to the cells that exist already. This reduces noise,
  // but takes longer, because the cell of every pixel's ray must be found (thesis 5.3).
  bool averages_others = false;
  // Sigma of a Gaussian that smooths each channel over the LF pixels that recorded it. Reduces
  // noise if few rays are kept. At most kMostSigma_px; 0: colours as recorded.
  double colour_sigma_px = 0;
};

// The position of the slab and the width of its cells (slab_plan.h). Each value that is set
// overrides the planner's choice.
struct SlabChoices {
  std::optional<Vec3> position_world;    // position of the st plane
  std::optional<Vec3> forward_world;     // direction that the st plane faces
  std::optional<double> uv_distance_w;   // distance of the uv plane from the st plane; above 0
  std::optional<double> r_st_w, r_uv_w;  // widths of cells on each plane, world units; above 0
};

// The size of the coverage map (coverage_map.h).
struct CoverageOptions {
  size_t most_bytes = size_t{32} << 20;  // cells are widened if the map would be larger
  // Number of cells on the uv plane across the plate of the frame that sees the narrowest part of
  // the plane; fewer if cells would be narrower than eight LF pixels. A cell on the st plane is
  // half as wide as the smallest reach (kReach_sigmas * QueryKernel::sigma_st_w) of the frames.
  int cells_across = 64;
};

}  // namespace lf
