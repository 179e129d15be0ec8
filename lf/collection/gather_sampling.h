// How an element reads an LF image in *bilinear* (doc/ray.md, "What is added"): through which
// filter, and at how many positions.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Between LF pixels a ray takes
//   kNearest   the value of the nearest pixel
//   kBilinear  the mean of four pixels
//   kBicubic   sixteen pixels, by Catmull and Rom's cubics: restores some of what cameras blur over
//              a pixel, at three times the cost. Takes four if the outer pixels are not all in the
//              image and unmasked
//   kMosaic    sixteen pixels, or four where kAuto takes four. In RGB pixels made from a mosaic, a
//              recorded colour counts more than an interpolated one (mosaic_filter.h), and rays
//              count differently in each colour: up to kRecordedShare times
//   kAuto      as kBicubic, but as kBilinear if an element takes kBilinearFrom x kBilinearFrom
//              samples or more, whose mean hides the difference
enum class PixelFilter { kAuto, kNearest, kBilinear, kBicubic, kMosaic };

// Returns "auto", "nearest", "bilinear", "bicubic" or "mosaic".
const char* NameOf(PixelFilter filter);

inline constexpr int kBilinearFrom = 3;

// LF images that are finer by no more than this factor are read at one position per element.
inline constexpr double kFinerAtMost = 1.25;
inline constexpr int kMostSamples = 16;

// Returns elements per LF pixel, along an edge: the square root of the area that an LF pixel covers
// on the plate. This is the smallest value at those of nine places of the plate that the LF image
// holds (or at all nine, if it holds none). 1 if nothing can be said.
double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// True if some pixels of the image have no ray, as beyond the fold of a lens. Such an image is
// never read by sixteen pixels.
bool MayLackRays(const Intrinsics& k);

// How one LF image is read in one frame.
struct GatherSampling {
  PixelFilter filter = PixelFilter::kBilinear;  // not kAuto
  bool is_cubic = false;                        // takes sixteen pixels where all are there
  // Samples along each edge of an element. Its ray is the mean of samples^2 evenly spaced rays, or
  // of those that exist. The number says how many times smaller than an element LF pixels are,
  // rounded up; at most kMostSamples.
  int samples = 1;
};
GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          PixelFilter filter);

// Returns the camera with the same picture on elements that are `samples` times finer.
RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples);

}  // namespace lf
