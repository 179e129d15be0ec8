// Finds the distance of the point that a person clicks on. A light field has no depths: they are
// searched along the ray, for a depth at which the LF images around it agree (plane sweep).
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct FocusPick {
  Vec3 point_world;
  // In [0, 1]: high if the LF images agree well at this depth, and much better than at others.
  double certainty = 0;
  std::vector<LfImageId> images;  // compared images; the first is the nearest to the ray's origin
};

// A pick below this certainty is a guess, as on patterns that repeat, and on outlines.
inline constexpr double kLeastCertainty = 0.2;

// Returns the ray of the continuous position (x, y) of an LF image, lens distortion undone. None if
// the position has no ray.
std::optional<Ray> RayOfLfPixel(const PinholeCamera& lf_camera, double x_px, double y_px);

// Returns the point of the scene that the ray meets. The compared images are around the ray's
// origin, about as far from it as the rim of the frame's lens, because the disparity between them
// is the blur of the lens.
//   ray    from the lens centre of `frame`, or from an LF camera
//   store  one with Mosaics::kToRgb
// kInput, in words for the person who clicked: too few LF cameras see the point, it has no texture,
// or the images agree on no depth. Errors of store.Load() if too few images can be read.
Result<FocusPick> FindFocus(const LightField& light_field, const LfImageStore& store,
                            const RenderCamera& frame, const Ray& ray, ThreadPool& pool);

// Returns the focus distance with which the frame's focus plane, with its tilt, contains the point.
double FocusDistanceThrough(const RenderCamera& frame, const Vec3& point_world);

}  // namespace lf
