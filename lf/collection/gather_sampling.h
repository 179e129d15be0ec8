// Decides how the estimator *bilinear* samples an LF image for an element (doc/ray.md, "What is
// added"): with which filter, and at how many positions.
#pragma once

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"

namespace lf {

// Filters that compute the value of a ray from the LF pixels around it:
//   kNearest   takes the value of the nearest pixel
//   kBilinear  interpolates linearly between four pixels
//   kBicubic   interpolates between sixteen pixels by Catmull and Rom's cubics. This restores some
//              of the sharpness that is lost because a camera averages over each pixel, and takes
//              three times as long as kBilinear. If one of the outer twelve pixels is outside the
//              image or masked, the ray is bilinear
//   kMosaic    is for RGB pixels made from a mosaic. It uses sixteen pixels, or four where kAuto
//              does. A recorded colour counts more than an interpolated one (mosaic_filter.h), and
//              the ray adds a count from 1 to kRecordedShare to each colour
//   kAuto      is kBicubic, or kBilinear if an element has kBilinearFrom x kBilinearFrom samples or
//              more, because the mean of the samples hides the difference
enum class PixelFilter { kAuto, kNearest, kBilinear, kBicubic, kMosaic };

// Returns "auto", "nearest", "bilinear", "bicubic" or "mosaic".
const char* NameOf(PixelFilter filter);

inline constexpr int kBilinearFrom = 3;

// If LF pixels are finer than elements by at most this factor, an element samples one position.
inline constexpr double kFinerAtMost = 1.25;
inline constexpr int kMostSamples = 16;  // largest number of samples along an edge of an element

// Returns the magnification, the number of elements per LF pixel along an edge: the square root of
// the area, in elements, that an LF pixel covers on the plate. It is computed at nine points of the
// plate. The result is the smallest value at the points that the LF image shows, or the smallest of
// all if it shows none of them. Returns 1 if there is no value at any of them.
double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera);

// True if some pixels of the image have no ray because they lie beyond the fold of the lens
// distortion. Such an image is never interpolated between sixteen pixels.
bool MayLackRays(const Intrinsics& k);

// How the elements of one frame sample one LF image.
struct GatherSampling {
  PixelFilter filter = PixelFilter::kBilinear;  // never kAuto
  bool is_cubic = false;  // true: interpolates between sixteen pixels where possible
  // Number of samples along each edge of an element: the number of LF pixels along an edge, rounded
  // up, at most kMostSamples; 1 if that number is at most kFinerAtMost. The element's ray is the
  // mean of samples^2 evenly spaced rays, or of as many of these as exist.
  int samples = 1;
};
GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          PixelFilter filter);

// Returns the render camera with a plate that has `samples` times as many rows and columns of
// elements for the same picture.
RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples);

}  // namespace lf
