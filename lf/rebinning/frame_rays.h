// Rebinned rays as one frame sees them: the point of the lens and the position on the plate of
// each. The slab is replaced by the frame's lens plane and focus plane (thesis 4.3.2,
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
  float lens_x_w = 0;  // lens coordinates: right, up
  float lens_y_w = 0;
  float x_px = 0;  // on the sensor plate, continuous
  float y_px = 0;
  std::array<float, 3> rgb = {};  // linear, 0 to 65535
};

// How far around the lens and beside the plate rays still count.
struct FrameReach {
  double lens_w = 0;
  double plate_px = 0;
};

// The squares of kSide x kSide elements that ask for rays; all of them by default.
struct AskedSquares {
  static constexpr int kSide = 8;
  int columns = 0;
  std::vector<bool> asked;  // [rows][columns]; empty: all
};

// Returns the middle rays of cells, in the order of the cells. Leaves out rays that do not run
// forward, that pass the lens plane farther than radius + reach.lens_w from its centre, that meet
// the plate more than reach.plate_px beside its edge, or that no square asks for. A ray beside the
// plate belongs to the square of the nearest element.
LargeVector<FrameRay> FrameRaysOf(const Slab& slab, std::span<const BinnedCell> cells,
                                  const RenderCamera& frame, const FrameReach& reach,
                                  ThreadPool& pool, const AskedSquares& squares = {});

// Returns the middle rays of cells for queries through a single lens point, without replacing the
// slab: the distance between a ray and the query is measured on the slab's planes (Eq. 4.5
// literally). The position of a ray on the plate is that of the asked ray, which runs from the lens
// point to the ray's point of the uv plane. Its point of the lens is the lens point plus the
// distance between the two rays on the st plane.
LargeVector<FrameRay> FrameRaysThrough(const Vec2& lens_point, const Slab& slab,
                                       std::span<const BinnedCell> cells, const RenderCamera& frame,
                                       const FrameReach& reach, ThreadPool& pool);

}  // namespace lf
