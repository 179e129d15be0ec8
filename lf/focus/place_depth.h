// SPDX-License-Identifier: Apache-2.0
// Finds the depth of one textured place of an LF image by comparing it with the LF images around it
// (plane sweep).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/camera/ray_through.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/focus/reduced_image.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr int kHalfPatch = 4;  // half width of a patch, in pixels of the reduced image
inline constexpr int kPatchSide = 2 * kHalfPatch + 1;
inline constexpr int kPatchSize = kPatchSide * kPatchSide;
using Patch = std::array<float, kPatchSize>;

// An LF image that places are compared with.
struct View {
  LfImageId id;
  RayThrough rays;
  double offset_w = 0;  // distance from the camera of the place (Place), normal to its axis
  std::shared_ptr<const ReducedImage> image = nullptr;  // nullptr: not loaded
};

using Rings = std::vector<std::vector<View>>;   // the innermost ring first
inline constexpr size_t kLeastViewsOfRing = 2;  // least number of views of a ring that is used

// Returns LF cameras around `camera` in up to six rings: at one and two spacings of the LF cameras,
// then each four times as wide as the one before. A ring contains the LF cameras nearest to six
// evenly spread positions. Other rings than the innermost have at least two views. Images are not
// loaded.
Rings ChooseRings(const LightField& field, LfImageId camera);

// A place in the image of one LF camera (the camera of the place): the ray of the place, the
// directions to the pixels around it, and these pixels.
struct Place {
  Vec2 at_px;              // position in the LF image
  Vec3 origin, direction;  // ray of the place; the direction advances by 1 along the optical axis
  Vec3 right, down;        // steps to the next reduced pixel, in the plane at depth 1
  double weight = 0;       // larger with more texture and nearer to the middle of the image
  Patch patch;             // pixels of the reduced image, minus their mean
  double deviation = 0;    // standard deviation of the patch

  // Returns the point, in world coordinates, that the camera of the place sees at a depth and at an
  // offset of (x, y) reduced pixels from the place.
  Vec3 At(double depth_w, double x, double y) const {
    return origin + depth_w * (direction + x * right + y * down);
  }
};

// Returns up to 176 places with texture, evenly spread over the image of `camera`. Mere noise, as
// in dark surroundings of an object, is no texture.
//   image  the reduced image of `camera`
std::vector<Place> TexturedPlaces(const LightField& field, LfImageId camera,
                                  const ReducedImage& image);

// The positions at which a view records the pixels around a place at a depth: centre + x step_x + y
// step_y, in pixels of the view's LF image, for integers x and y within +-kHalfPatch.
struct PatchGrid {
  Vec2 centre, step_x, step_y;

  // Returns the position of pixel `index` of a Patch.
  Vec2 At(int index) const {
    return centre + (index % kPatchSide - kHalfPatch) * step_x +
           (index / kPatchSide - kHalfPatch) * step_y;
  }
};
// Returns the grid of a place at a depth in a view, which may lie outside the view's image. None if
// the view's lens has no image of the place at this depth.
std::optional<PatchGrid> PatchSeenBy(const View& view, const Place& place, double depth_w);

// Returns the correlation of the place's patch with the view's pixels at a depth, in [-1, 1]; -1 if
// the view does not show the whole patch.
double CorrelationAt(const View& view, const Place& place, double depth_w);

struct FoundDepth {
  double distance_w = 0, weight = 0;
  double error = 0;  // standard deviation of the depth, relative to distance_w
};

// Reasons for which a place has no depth.
enum class NoDepth {
  kDisagreement,  // the views agree on no depth
  kAmbiguous,     // the views agree on several depths, or the place is a watermark
  kFar,           // the place is so far away that it does not move
};

// Returns the depth on which most views agree. None if they agree on no depth, or almost as well on
// another one; if the place does not move from view to view, like a watermark; or if it is so far
// away that it moves by less than a reduced pixel.
//   rings      rings of views whose images are loaded; at least one ring, each with at least two
//              views
//   k          intrinsics of the camera of the place
//   divisor    divisor of the reduced images (ReducedImage::divisor)
//   nearest_w  no nearer depth is tested; 0: tests from the least depth that the images of the
//              innermost ring can show
//   why        receives the reason if there is no depth; may be null
std::optional<FoundDepth> DepthOf(const Rings& rings, const Place& place, const Intrinsics& k,
                                  int divisor, double nearest_w = 0, NoDepth* why = nullptr);

}  // namespace lf
