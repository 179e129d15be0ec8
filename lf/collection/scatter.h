// Ray collection, estimator *nearest* (thesis 4.3.1; doc/ray.md): every pixel of an LF image is one
// ray, added to the element it hits.
//
// One test compares two back ends. The reference asks the ray model for every pixel. The fast one
// works in two steps, so that many threads can share one plate, and many plates one LF image:
//   1. PlanScatter, once per (LF image, frame): the accepted pixels of each scanline, in segments
//      along which the element position is a polynomial, cut where they leave a tile.
//   2. ScatterTile, once per (LF image, frame, tile of the plate): the rays that land in the tile.
// Tolerance: both accept exactly the same rays. A ray within 1e-4 elements of an element's border
// may land in the neighbour, because the fast back end evaluates positions in single precision. A
// tile takes exactly the rays whose address, computed in this way, lies in it. The bits are the
// same for any cut into tiles or rectangles and on every instruction set. With lens distortion the
// reference iterates and the fast one follows arcs: rays within IdealPixels::kTolerance_px of a
// border of lens or plate may also differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/lf_pixels.h"
#include "lf/collection/segments.h"
#include "lf/collection/tile_pieces.h"
#include "lf/core/geometry.h"
#include "lf/plate/sensor_plate.h"
#include "lf/plate/tile_grid.h"
#include "lf/plate/tile_sums.h"

namespace lf {

// Adds the rays of pixels `rect` of one LF image. Masked pixels give no ray. A pixel of a mosaic
// adds to its own channel, an RGB pixel to all three. Returns the number of accepted rays.
//   pixels   must hold `rect`
//   plate    has the size of the render camera's
//   weights  a ray of weight w adds w times its value, and counts w times
uint64_t ScatterReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                          const RenderCamera& render_camera, const PixelRect& rect,
                          SensorPlate* plate, const RayWeights& weights = {});

struct ScatterPlan {
  TileGrid grid;
  // Accepted pixels of scanlines. Positions are in elements: a pixel hits floor(position), clamped
  // to the plate, because the ray model has accepted it.
  std::vector<Segment> segments;
  TilePieces pieces;
};

// Plans the accepted rays of `rect`. The ray model confirms the ends of every span.
//   grid          tiles of a plate of the render camera's size
//   ideal_pixels  of lf_camera's intrinsics, for a camera with distortion
//   memory        a plan no longer needed, whose memory is used again
ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const TileGrid& grid,
                        const IdealPixels* ideal_pixels = nullptr, ScatterPlan memory = {});

// Adds the rays of `plan` that land in one tile of its grid, which is the tile of `sums`. The
// caller flushes `sums`. Returns the number of rays.
//   pixels   must hold the rectangle that was planned
//   weights  as for the reference, whatever the cut into tiles
uint64_t ScatterTile(const ScatterPlan& plan, size_t tile, const LfPixels& pixels, TileSums* sums,
                     const RayWeights& weights = {});

}  // namespace lf
