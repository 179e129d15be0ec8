// Ray collection, estimator *bilinear* (doc/ray.md, "What is added"): every element asks every LF
// image for the ray through its centre, interpolated between LF pixels; where these are finer than
// elements, for the mean of several (gather_sampling.h). For RGB images.
//
// Two back ends, compared by one test. The reference intersects planes for every element. The fast
// one works in two steps, as scatter.h does:
//   1. PlanGather, once per (LF image, frame): the accepted elements of each row of the plate, in
//      segments along which the position in the LF image is a polynomial.
//   2. GatherTile, once per (LF image, frame, tile of the plate).
// Tolerance: both accept the same rays, but for rays within 1e-9 of a border of lens or image.
// Positions of the fast one are true to 1e-4 px, so the weights, in steps of 1/256 px, may differ
// by a step. The same bits for any cut into tiles and on every instruction set.
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

// A ray of R, G and B, which counts so many times in each.
struct RgbRay {
  std::array<uint16_t, 3> value = {};
  std::array<uint32_t, 3> count = {1, 1, 1};
  friend bool operator==(const RgbRay&, const RgbRay&) = default;
};

// v of the LF image at continuous position (x, y), interpolated in integers: bilinear between the
// four nearest pixel centres with weights in 1/256, rounded half up, or as cubic_weights.h and
// mosaic_filter.h say. None unless the four are in the image (of `width_px` x `height_px`) and not
// masked; where others of the sixteen are not, the four make the value.
//   pixels  RGB; must hold them wherever they are in the image
std::optional<RgbRay> InterpolatePixels(const LfPixels& pixels, int width_px, int height_px,
                                        double x_px, double y_px,
                                        const GatherSampling& sampling = {});

// Whether rays arrive at the four pixel centres around (x, y): beyond the fold of a lens none do.
bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px);

// Adds one ray to each element that has one in this LF image. Returns how many.
//   plate   has the size of the render camera's
//   weights  a ray adds so many times its value, and counts as so many
uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate,
                         const RayWeights& weights = {}, PixelFilter filter = PixelFilter::kAuto);

struct GatherPlan {
  GatherSampling sampling;
  int plate_width = 0;
  int plate_height = 0;
  // Of positions on the finer plate of sampling.samples, all accepted, by y, then x.
  std::vector<Segment> segments;
  std::vector<size_t> row_begin;  // [plate_height * samples + 1]: the first segment of a row
};

//   memory  a plan no longer needed, to be used again
GatherPlan PlanGather(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                      GatherPlan memory = {}, PixelFilter filter = PixelFilter::kAuto);

// Adds the rays of the elements in the tile of `sums`, which the caller flushes. Returns how many.
//   pixels  RGB; must hold what the filter wants around every ray
//   weights  as for the reference, on every cut into tiles
uint64_t GatherTile(const GatherPlan& plan, const LfPixels& pixels, TileSums* sums,
                    const RayWeights& weights = {});

}  // namespace lf
