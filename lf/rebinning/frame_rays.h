// Rebinned rays as one frame sees them: through which point of the lens, to which element. The
// slab is exchanged for the frame's own, its lens plane and its focus plane (thesis 4.3.2,
// "reparameterization"): tilted focus planes are planes like others.
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
  float lens_x_w = 0;  // lens coordinates: right, up
  float lens_y_w = 0;
  float x_px = 0;  // on the sensor plate, continuous
  float y_px = 0;
  std::array<float, 3> rgb = {};  // linear, of 16 bits
};

// Rays, and how far around the lens and beside the plate they still count.
struct FrameReach {
  double lens_w = 0;
  double plate_px = 0;
};

// Squares of kSide elements that rays are asked for, all of them by default.
struct AskedSquares {
  static constexpr int kSide = 8;
  int columns = 0;
  std::vector<bool> asked;  // [rows][columns]; empty: all
};

// The middle rays of cells that run forward, through the lens's plane within radius + reach.lens_w
// of its centre, to the plate or reach.plate_px beside it, where they are asked for; in the order
// of the cells.
LargeVector<FrameRay> FrameRaysOf(const Slab& slab, std::span<const BinnedCell> cells,
                                  const RenderCamera& frame, const FrameReach& reach,
                                  ThreadPool& pool, const AskedSquares& squares = {});

// The same as a single point of the lens asks for them, without exchanging the slab: a ray is as
// far from the query as their points on the slab's planes are (Eq. 4.5 as it stands). So each is
// where the ray from the lens point to its point of the uv plane meets the plate, and beside the
// lens point as far as the two are from each other on the st plane.
LargeVector<FrameRay> FrameRaysThrough(const Vec2& lens_point, const Slab& slab,
                                       std::span<const BinnedCell> cells, const RenderCamera& frame,
                                       const FrameReach& reach, ThreadPool& pool);

}  // namespace lf
