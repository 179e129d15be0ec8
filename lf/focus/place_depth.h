// Finds the depth of one textured place of an LF image by comparing it with the LF images around it
// (plane sweep). For find_subject.cc, and for stages that compare LF images themselves.
#pragma once

#include <array>
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

inline constexpr int kHalfPatch = 4;  // pixels of the reduced image
inline constexpr int kPatchSide = 2 * kHalfPatch + 1;
inline constexpr int kPatchSize = kPatchSide * kPatchSide;
using Patch = std::array<float, kPatchSize>;

// An LF image that places are compared with.
struct View {
  LfImageId id;
  RayThrough rays;
  double offset_w = 0;  // distance from the camera
  std::shared_ptr<const ReducedImage> image = nullptr;
};

using Rings = std::vector<std::vector<View>>;  // the innermost ring first

// Returns LF cameras around `camera` in up to five rings, every ring four times as wide as the one
// before. A ring has the LF cameras nearest to six evenly spread positions. Images are not loaded.
Rings ChooseRings(const LightField& field, LfImageId camera);

// A place of the camera's image: its ray, and the rays of the pixels around it.
struct Place {
  Vec2 at_px;              // in the LF image
  Vec3 origin, direction;  // depth 1 along the optical axis
  Vec3 right, down;        // one reduced pixel, at depth 1
  double weight = 0;       // larger with more texture, and nearer to the middle
  Patch patch;             // of the camera's image, mean 0
  double deviation = 0;

  Vec3 At(double depth_w, double x, double y) const {
    return origin + depth_w * (direction + x * right + y * down);
  }
};

// Returns up to 176 places with texture, evenly spread over the image of `camera`.
std::vector<Place> TexturedPlaces(const LightField& field, LfImageId camera,
                                  const ReducedImage& image);

// The pixels around a place at a depth, as a view records them: the pixels of the patch lie at
// centre + x step_x + y step_y, in pixels of the view's LF image, for integers x and y within
// +-kHalfPatch.
struct PatchGrid {
  Vec2 centre, step_x, step_y;

  // Returns the position of the pixel `index` of a Patch.
  Vec2 At(int index) const {
    return centre + (index % kPatchSide - kHalfPatch) * step_x +
           (index / kPatchSide - kHalfPatch) * step_y;
  }
};
// Returns the grid of a place at a depth in a view; none if the view's lens has no such rays.
std::optional<PatchGrid> PatchSeenBy(const View& view, const Place& place, double depth_w);

// Returns the correlation of the place's patch with the view's pixels at a depth, in [-1, 1]; -1 if
// the view does not show the place.
double CorrelationAt(const View& view, const Place& place, double depth_w);

struct FoundDepth {
  double distance_w = 0, weight = 0;
  double error = 0;  // relative to distance_w
};

// Returns the depth on which most views agree. None if there is no clear depth, if the place stands
// still in all views, as a watermark does, or if it is so far that nothing moves.
//   rings      of views whose images are loaded; at least one ring, each of at least two views
//   k          of the camera
//   divisor    of the reduced images
//   nearest_w  no nearer depths are tested; 0: the nearest that the inner ring's images can show
std::optional<FoundDepth> DepthOf(const Rings& rings, const Place& place, const Intrinsics& k,
                                  int divisor, double nearest_w = 0);

}  // namespace lf
