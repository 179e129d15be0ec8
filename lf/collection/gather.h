// SPDX-License-Identifier: Apache-2.0
// Ray collection, estimator *bilinear* (doc/ray.md, "What is added"): an element collects one ray
// from each LF image: the ray through the centre of the element, interpolated between LF pixels. If
// LF pixels are finer than elements, this ray is the mean of several rays through the element, or
// is read from an LF image that was filtered before (gather_sampling.h). LF images must be RGB.
//
// There are two back ends, which a test compares. The reference intersects planes for every
// element. The fast back end works in two steps, as in scatter.h:
//   1. PlanGather, called once per (LF image, frame), finds the accepted elements of each row of
//      the plate and cuts them into segments along which the position in the LF image is a
//      polynomial.
//   2. GatherTile, called once per (LF image, frame, tile of the plate), adds the rays of these
//      elements.
// A camera with a focal surface is collected piece by piece (ForEachPiece()), with one sampling.
// Tolerance: both accept the same rays, except for rays that a relative error of 1e-9 would move
// across a border of lens or image. Positions of the fast back end are accurate to 1e-4 px. Its
// interpolation weights, in steps of 1/256, may therefore differ by one step from those of the
// reference. Its results are bit-identical for any cut into tiles and on every instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/collection/gather_sampling.h"
#include "lf/collection/segments.h"
#include "lf/core/geometry.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_sums.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// The value of a ray in R, G and B.
using RgbRay = std::array<uint16_t, 3>;

// Returns the ray that the LF image recorded at the continuous position (x, y), interpolated in
// integers as `sampling` says: bilinearly between the four nearest pixel centres with weights in
// 1/256, rounded half up, or as cubic_weights.h says. Returns none unless these
// four pixels are in the image (of `width_px` x `height_px`) and not masked. If sixteen pixels
// should be used, but one of the other twelve is missing or masked, the four alone are
// interpolated.
//   pixels  RGB, already filtered by sampling.prefilter; must hold those of the four or sixteen
//           pixels that are in the image
std::optional<RgbRay> InterpolatePixels(const LfPixels& pixels, int width_px, int height_px,
                                        double x_px, double y_px,
                                        const GatherSampling& sampling = {});

// True if each of the four pixels whose centres are around (x, y) recorded a ray. Pixels beyond the
// fold of the lens distortion recorded none.
bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px);

// Adds to each element the ray that the LF image recorded for the element, if there is one. Returns
// the number of rays, including rays of weight 0.
//   pixels   RGB, not filtered; must hold the pixels that the filter needs around every ray
//   plate    must have the size of the render camera's plate
//   weights  weight w multiplies the value and the count that a ray adds
uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights = {}, const PixelReading& reading = {});

struct GatherPlan {
  GatherSampling sampling;
  int plate_width = 0;
  int plate_height = 0;
  // The accepted elements of the finer plate, which has sampling.samples times as many rows and
  // columns as the plate, sorted by y, then x. Positions are in LF pixels.
  std::vector<Segment> segments;
  std::vector<size_t> row_begin;  // [plate_height * samples + 1]: index of a row's first segment
};

// Finds the accepted elements of each row of the plate.
//   memory  a plan that is no longer needed; its memory is reused
GatherPlan PlanGather(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                      GatherPlan memory = {}, const PixelReading& reading = {});

// Adds the rays of the elements in the tile of `sums` to `sums`. The caller flushes `sums` to the
// plate. Returns the number of rays, including rays of weight 0. Returns 0 if all weights are
// 0 in the smallest rectangle of elements that is known to contain the rays.
//   pixels   RGB, already filtered by plan.sampling.prefilter (FilterPixels()); must hold every
//            pixel that a ray is interpolated between
//   weights  as for GatherReference(): of the whole plate, not of the tile
uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums,
                    const RayWeights& weights = {});

}  // namespace lf
