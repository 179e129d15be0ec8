// Ray collection, estimator *bilinear* (doc/ray.md, "What is added"): every element asks every LF
// image for the ray through its centre, interpolated between four LF pixels. For RGB images.
//
// Two back ends, compared by one test. The reference intersects planes for every element; the fast
// one evaluates linear forms of the element position, a chunk of a row at a time. Tolerance: rays
// within 1e-9 of a border of lens or image may be accepted by one of them only, and values differ
// by rounding of the interpolation's weights, 1/256 pixel.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/lf_pixels.h"
#include "lf/core/geometry.h"
#include "lf/plate/sensor_plate.h"
#include "lf/plate/tile_sums.h"

namespace lf {

// v of the LF image at continuous position (x, y), bilinear between the four nearest pixel centres
// with weights in 1/256, rounded half up. None unless all four are in the image (of `width_px` x
// `height_px`) and not masked.
//   pixels  RGB; must hold the four wherever they are in the image
std::optional<std::array<uint16_t, 3>> InterpolatePixels(const LfPixels& pixels, int width_px,
                                                         int height_px, double x_px, double y_px);

// Whether rays arrive at the four pixel centres around (x, y): beyond the fold of a lens none do.
bool RaysArriveAround(const Intrinsics& k, const DistortionMap& map, double x_px, double y_px);

// Adds one ray to each element that has one in this LF image. Returns how many.
//   plate  has the size of the render camera's
uint64_t GatherReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                         const RenderCamera& render_camera, SensorPlate* plate);

// The linear forms of an element position e for one (LF camera, render camera): X is the point of
// the focus plane that the element sees, d = +-(X - c) the direction of its ray, forward.
class GatherPlan {
 public:
  GatherPlan(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

  // Adds the rays of the tile's elements to the sums, which the caller flushes. Returns how many.
  // The same bits for any cut into tiles.
  uint64_t GatherTile(const LfPixels& pixels, TileSums* sums) const;

 private:
  struct Chunk;
  void FindRays(int y, int x_begin, int count, Chunk* chunk) const;
  bool IsInPolygon(double right, double up, double forward) const;

  Intrinsics intrinsics_;  // of the LF camera
  std::optional<DistortionMap> distortion_;
  bool may_lack_rays_ = false;  // some pixels of the image have none
  double plane_sign_ = 1;       // of n.(X - c') for points before the lens
  PixelForm plane_;       // n.d' of the element's own ray; X is before the lens where its sign fits
  PixelForm forward_;     // f.(X - c), times |n.d'|
  PixelForm lens_right_;  // lens position = (lens_right e, lens_up e) / (forward e)
  PixelForm lens_up_;
  PixelForm across_x_;  // X - c in axes of the LF camera, times K for pinholes, and |n.d'|
  PixelForm across_y_;
  PixelForm depth_;
  double radius2_w2_ = 0;            // with the rim's tolerance
  std::vector<ApertureEdge> edges_;  // of a polygon
};

}  // namespace lf
