// Ray collection, estimator *bilinear* (doc/ray.md, "What is added"): every element asks every LF
// image for the ray through its centre, interpolated between LF pixels. If these are finer than
// elements, it takes the mean of several such rays (gather_sampling.h). For RGB images.
//
// One test compares two back ends. The reference intersects planes for every element. The fast one
// works in two steps, as in scatter.h:
//   1. PlanGather, once per (LF image, frame): the accepted elements of each row of the plate, in
//      segments along which the position in the LF image is a polynomial.
//   2. GatherTile, once per (LF image, frame, tile of the plate).
// Tolerance: both accept the same rays, except for rays within 1e-9 of a border of lens or image.
// Positions of the fast one are accurate to 1e-4 px, so that weights, in steps of 1/256 px, may
// differ by a step. The fast one gives the same bits for any cut into tiles and on every
// instruction set.
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
#include "lf/capture/lf_pixels.h"
#include "lf/collection/gather_sampling.h"
#include "lf/collection/segments.h"
#include "lf/core/geometry.h"
#include "lf/plate/sensor_plate.h"
#include "lf/plate/tile_sums.h"

namespace lf {

// A ray of R, G and B, and what it counts in each colour.
struct RgbRay {
  std::array<uint16_t, 3> value = {};
  std::array<uint32_t, 3> count = {1, 1, 1};
  friend bool operator==(const RgbRay&, const RgbRay&) = default;
};

// Returns v of the LF image at continuous position (x, y), interpolated in integers: bilinear
// between the four nearest pixel centres with weights in 1/256, rounded half up, or as
// cubic_weights.h and mosaic_filter.h say. None unless the four are in the image (of `width_px` x
// `height_px`) and not masked. If others of the sixteen are not, the four make the value.
//   pixels  RGB; must hold those of these pixels that are in the image
std::optional<RgbRay> InterpolatePixels(const LfPixels& pixels, int width_px, int height_px,
                                        double x_px, double y_px,
                                        const GatherSampling& sampling = {});

// True if rays arrive at the four pixel centres around (x, y). Beyond the fold of a lens none do.
bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px);

// Adds one ray to each element that has one in this LF image. Returns the number of rays.
//   plate    has the size of the render camera's
//   weights  a ray of weight w adds w times its value, and counts w times
uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights = {}, PixelFilter filter = PixelFilter::kAuto);

struct GatherPlan {
  GatherSampling sampling;
  int plate_width = 0;
  int plate_height = 0;
  // Accepted positions on the finer plate of sampling.samples, by y, then x.
  std::vector<Segment> segments;
  std::vector<size_t> row_begin;  // [plate_height * samples + 1]: the first segment of a row
};

// Plans the accepted elements of each row.
//   memory  a plan no longer needed, whose memory is used again
GatherPlan PlanGather(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                      GatherPlan memory = {}, PixelFilter filter = PixelFilter::kAuto);

// Adds the rays of the elements in the tile of `sums`, which the caller flushes. Returns the number
// of rays.
//   pixels   RGB; must hold the pixels that the filter needs around every ray
//   weights  as for the reference, whatever the cut into tiles
uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums,
                    const RayWeights& weights = {});

}  // namespace lf
