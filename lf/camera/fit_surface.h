// SPDX-License-Identifier: Apache-2.0
// Makes a focal surface of the depths of all elements of a camera.
#pragma once

#include <cstddef>

#include "lf/camera/focal_surface.h"
#include "lf/camera/render_camera.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

struct SurfaceFitOptions {
  // Diameter of the lens, in focal lengths of the plate times elements: an element whose inverse
  // depth is wrong by d is blurred over d * blur_px_w elements. It is the diameter in world units
  // times fx_px.
  double blur_px_w = 0;
  // A rectangle is divided if the blur of one of its elements exceeds this, in elements.
  double most_blur_px = 0.5;
  // Rectangles are not divided below this side, in elements.
  int least_side_px = 2;
  // Largest number of pieces; 0: one for each kElementsPerPiece elements, at least kLeastPieces.
  size_t most_pieces = 0;
};
inline constexpr size_t kElementsPerPiece = 96;
inline constexpr size_t kLeastPieces = 1024;

// Replaces unknown inverse depths, which are 0, negative, infinite or NaN, by that of the nearest
// known one along rows and columns (the city-block distance; the first in the order of rows if
// several are equally near). Returns the number of those that were unknown. All of them stay
// unknown if none is known.
//   inverse_depths  [height][width], in 1 / world units
size_t FillUnknown(Image<float>* inverse_depths);

struct FittedSurface {
  FocalSurface surface;
  double most_blur_px = 0;  // largest blur of an element by the difference from the depths given
  double mean_blur_px = 0;  // mean blur
  size_t beyond_count = 0;  // number of elements with a blur above SurfaceFitOptions::most_blur_px
};

// Returns a surface near the inverse depths of all elements, at their centres. The plate is divided
// into squares, and these into four as long as a plane through their elements (fitted to the
// inverse depths by least squares) blurs one by more than most_blur_px. If there are more than
// most_pieces, those are divided first whose elements have the largest sum of squared blurs beyond
// the limit. A piece that cannot be divided although its elements are beyond the limit takes the
// plane, or the median depth, whichever is nearer to more of them (in the mean).
//   inverse_depths  [height][width], all above 0 and finite
FittedSurface FitSurface(const Image<float>& inverse_depths, const SurfaceFitOptions& options);

// How well the surface of a camera was fitted (FittedSurface).
struct SurfaceFit {
  double most_blur_px = 0;
  double mean_blur_px = 0;
  size_t beyond_count = 0;
};

// Gives the camera a surface near the inverse depths of its elements: FitSurface(), for the lens of
// the camera. A lens narrower than two distances between LF cameras counts as one of this width,
// because frames through it take light from so many.
//   inverse_depths     [height][width] of the camera's plate, all above 0 and finite
//   camera_distance_w  distance between neighbouring LF cameras
SurfaceFit SetSurface(const Image<float>& inverse_depths, double most_blur_px,
                      double camera_distance_w, RenderCamera* camera);

}  // namespace lf
