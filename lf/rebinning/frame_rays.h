// SPDX-License-Identifier: Apache-2.0
// Rebinned rays as one frame sees them: each with its point of the lens and its position on the
// plate. The frame's lens plane and focus plane take the place of the slab (thesis 4.3.2,
// "reparameterization"). Tilted focus planes need no special case.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/large_vector.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/ray_map.h"
#include "lf/rebinning/slab.h"

namespace lf {

struct FrameRay {
  float lens_x_w = 0;  // position on the lens: to the right and up, world units
  float lens_y_w = 0;
  float x_px = 0;  // continuous position on the sensor plate
  float y_px = 0;
  std::array<float, 3> rgb = {};  // linear radiance, 0 to 65535
};

// The largest distances, outside the lens and beside the plate, at which rays are returned.
struct FrameReach {
  double lens_w = 0;
  double plate_px = 0;
};

// The squares of kSide x kSide elements that need rays; by default all squares of the plate.
struct AskedSquares {
  static constexpr int kSide = 8;
  int columns = 0;
  std::vector<bool> asked;  // [rows][columns]; empty: all squares need rays
};

// Returns the rays through the middles of cells, in the order of the cells. Leaves out rays that do
// not run forward, that pass the lens plane farther than the lens radius + reach.lens_w from the
// lens centre, that have no focus point in front of the lens, that meet the plate more than
// reach.plate_px beside its edge, or whose square is not in `squares`. The square of a ray beside
// the plate is that of the nearest element.
LargeVector<FrameRay> FrameRaysOf(const Slab& slab, std::span<const BinnedCell> cells,
                                  const RenderCamera& frame, const FrameReach& reach,
                                  ThreadPool& pool, const AskedSquares& squares = {});

// Returns the rays through the middles of cells for queries through a single lens point, with
// distances measured on the slab's planes instead of the frame's (Eq. 4.5 literally). For each ray,
// the query runs from the lens point to the point where the ray meets the uv plane. The ray gets
// the query's position on the plate. Its point of the lens is the lens point plus the difference
// between the points where ray and query meet the st plane. Leaves out rays for which this
// difference is longer than reach.lens_w, or whose query meets the plate more than reach.plate_px
// beside its edge.
LargeVector<FrameRay> FrameRaysThrough(const Vec2& lens_point, const Slab& slab,
                                       std::span<const BinnedCell> cells, const RenderCamera& frame,
                                       const FrameReach& reach, ThreadPool& pool);

}  // namespace lf
