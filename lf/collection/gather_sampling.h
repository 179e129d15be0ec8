// How an element reads an LF image in *bilinear* (doc/ray.md, "What is added"): through which
// filter, and at how many places.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Between LF pixels a ray takes
//   kNearest   the value of the nearest one
//   kBilinear  the mean of four
//   kBicubic   sixteen, by Catmull and Rom's cubics: gives back some of what cameras blur over a
//              pixel, at three times the cost. Where the outer ones are not all in the image and
//              unmasked, the four.
//   kMosaic    sixteen, or four where kAuto takes four; in RGB pixels made from a mosaic, what was
//              recorded counts more than what was interpolated (mosaic_filter.h), and rays count
//              differently in each colour: up to kRecordedShare times
//   kAuto      kBicubic, but kBilinear where an element takes kBilinearFrom x kBilinearFrom
//              samples and more: their mean hides the difference
enum class PixelFilter { kAuto, kNearest, kBilinear, kBicubic, kMosaic };

// "auto", "nearest", "bilinear", "bicubic", "mosaic"
const char* NameOf(PixelFilter filter);

inline constexpr int kBilinearFrom = 3;

// LF images that are finer by no more than this are read at one place an element.
inline constexpr double kFinerAtMost = 1.25;
inline constexpr int kMostSamples = 16;

// Elements per LF pixel, along an edge: the square root of the area that an LF pixel covers of the
// plate, where it is smallest of nine places of the plate that the LF image holds (or of all nine,
// if it holds none). 1 if nothing can be said.
double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// Whether some pixels of the image have no ray, as beyond the fold of a lens. Of such an image
// never sixteen pixels are taken.
bool MayLackRays(const Intrinsics& k);

// Of one LF image in one frame.
struct GatherSampling {
  PixelFilter filter = PixelFilter::kBilinear;  // not kAuto
  bool is_cubic = false;                        // takes sixteen pixels, where they are
  // Along each edge of an element: its ray is the mean of samples^2 evenly spaced ones, or of those
  // that there are. As many as LF pixels are smaller than an element, rounded up, kMostSamples at
  // most.
  int samples = 1;
};
GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          PixelFilter filter);

// The same picture on so many times finer elements.
RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples);

}  // namespace lf
