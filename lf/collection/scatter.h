// Ray collection, estimator *nearest* (thesis 4.3.1; doc/ray.md): every pixel of an LF image is one
// ray, added to the element it hits.
//
// Two back ends, compared by one test. The reference asks the law of every pixel. The fast one
// works in two steps, so that many threads can share one plate and one LF image many plates:
//   1. PlanScatter, once per (LF image, frame): the spans of each scanline that are accepted.
//   2. ScatterBand, once per (LF image, frame, band of the plate): the rays of these spans that
//      land in the band.
// Tolerance: both accept exactly the same rays. A ray within 1e-9 elements of an element's border
// may land in the neighbour, since the reference intersects planes and the fast one divides linear
// forms; a band takes exactly the rays whose address, as the fast one computes it, lies in it.
// With lens distortion the reference iterates and the fast one follows arcs: rays within
// IdealPixels::kTolerance_px of a border of element, lens or plate may differ.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/camera/pinhole.h"
#include "lf/camera/ray_forms.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/lf_pixels.h"
#include "lf/core/geometry.h"
#include "lf/plate/sensor_plate.h"

namespace lf {

// Adds the rays of pixels `rect` of one LF image. Masked pixels give no ray; a pixel of a mosaic
// adds to its own channel, another to three. Returns how many rays were accepted.
//   pixels  must hold `rect`;  plate  has the size of the render camera's
uint64_t ScatterReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                          const RenderCamera& render_camera, const PixelRect& rect,
                          SensorPlate* plate);

// Pixels [x_begin, x_end) of scanline y, all accepted. Along a span the element moves monotonically
// in both coordinates; with lens distortion it lies on one arc instead.
struct RaySpan {
  int32_t y = 0;
  int32_t x_begin = 0;
  int32_t x_end = 0;
  // Range of element_y, continuous, over the span.
  float element_y_min = 0;
  float element_y_max = 0;
  uint32_t arc = 0;  // with lens distortion: index into the scanline's arcs
};

struct ScatterPlan {
  RayForms forms;
  int plate_width = 0;
  int plate_height = 0;
  const IdealPixels* ideal_pixels = nullptr;  // with lens distortion
  std::vector<RaySpan> spans;                 // by y, then x
};

// The spans of `rect`: exact, their ends confirmed by the law.
//   ideal_pixels  of lf_camera's intrinsics, for a camera with distortion; must outlive the plan
ScatterPlan PlanScatter(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                        const PixelRect& rect, const IdealPixels* ideal_pixels = nullptr);

// Adds the rays of `plan` that land in `band`. Returns how many. Bands of one plate may be written
// at the same time by different threads.
//   pixels  those the plan's rectangle was taken from
uint64_t ScatterBand(const ScatterPlan& plan, const LfPixels& pixels, PlateBand* band);

}  // namespace lf
