// SPDX-License-Identifier: Apache-2.0
// Ray collection, estimator *nearest* (thesis 4.3.1; doc/ray.md): every pixel of an LF image is one
// ray, added to the element it hits.
//
// There are two back ends, which tests compare. The reference applies the ray model to every pixel.
// The fast back end works in two steps, so that many threads can share one plate, and many plates
// one LF image:
//   1. PlanScatter, called once per (LF image, frame), finds the accepted pixels of each scanline.
//      It cuts them into segments along which the position on the plate is a polynomial, and cuts
//      the segments at the borders of tiles.
//   2. ScatterTile, called once per (LF image, frame, tile of the plate), adds the rays that land
//      in the tile.
// A camera with a focal surface is collected piece by piece (ForEachPiece()). A ray may then land
// on several elements, one of each piece that it passes through, and counts as often. Tolerance:
// both accept exactly the same rays. A ray within 1e-4 elements of an element's border may land in
// the next element, because the fast back end evaluates positions in single precision. A tile
// collects exactly the rays whose element, computed in this way, lies in it. Results are
// bit-identical for any cut of the plate into tiles, for any cut of the LF image into rectangles,
// and on every instruction set. With lens distortion, the reference undistorts by iteration and the
// fast back end by curves fitted to ideal positions: rays within IdealPixels::kTolerance_px of a
// border of lens or plate may therefore also differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/segments.h"
#include "lf/collection/tile_pieces.h"
#include "lf/core/geometry.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_grid.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Adds the accepted rays of the pixels in `rect` of one LF image to the plate. Masked pixels have
// no ray. A pixel of a mosaic adds to its own channel, an RGB pixel to all three. Returns the
// number of accepted rays, including rays of weight 0.
//   pixels   must hold `rect`
//   plate    must have the size of the render camera's plate
//   weights  weight w multiplies the value and the count that a ray adds
uint64_t ScatterReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                          const RenderCamera& render_camera, const PixelRect& rect,
                          SensorPlate* plate, const RayWeights& weights = {});

struct ScatterPlan {
  TileGrid grid;
  // The accepted pixels of each scanline. Positions are in elements: the ray of a pixel lands on
  // the element floor(position), clamped to the plate, because the ray model has accepted the ray.
  std::vector<Segment> segments;
  TilePieces pieces;
};

// Plans the accepted rays of `rect`. Where rounding might decide about the end of a span, the ray
// model decides instead.
//   grid          the tiles of the render camera's plate
//   ideal_pixels  the IdealPixels of lf_camera's intrinsics; must be given if lf_camera has lens
//                 distortion, and are not used otherwise
//   memory        a plan that is no longer needed; its memory is reused
ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const TileGrid& grid,
                        const IdealPixels* ideal_pixels = nullptr, ScatterPlan memory = {});

// Adds the rays of `plan` that land in tile `tile` of its grid to `sums`, which must be of this
// tile. The caller flushes `sums` to the plate. Returns the number of rays, including rays of
// weight 0; 0 if no element of the tile has a weight above 0.
//   pixels   must hold the rectangle that was planned
//   weights  as for ScatterReference(): of the whole plate, not of the tile
uint64_t ScatterTile(const ScatterPlan& plan, size_t tile, const LfPixels& pixels, TileSums* sums,
                     const RayWeights& weights = {});

}  // namespace lf
