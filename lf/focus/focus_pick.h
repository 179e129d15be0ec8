// At what distance lies what a person points at? A light field has no depth: it is searched along
// the ray, where the LF images around it agree (plane sweep).
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct FocusPick {
  Vec3 point_world;
  // In [0, 1]: how well the LF images agree there, and how much better than anywhere else.
  double certainty = 0;
  std::vector<LfImageId> images;  // that were compared; the first one nearest to the ray's origin
};

// Below it a pick is rather a guess: of patterns that repeat, and of outlines.
inline constexpr double kLeastCertainty = 0.2;

// Continuous position (x, y) of an LF image, lens distortion undone. None where it has no ray.
std::optional<Ray> RayOfLfPixel(const PinholeCamera& lf_camera, double x_px, double y_px);

// The point of the scene that the ray meets. The images are some around the ray's origin, about as
// far from it as the rim of the frame's lens: what these see apart is what the lens blurs.
//   ray    from the lens centre of `frame` or an LF camera
//   store  one with Mosaics::kToRgb
// kInput, in words for the person who has clicked: too few LF cameras see it, there is no texture,
// or nothing that they agree on. Errors of store.Load() where too few images can be read.
Result<FocusPick> FindFocus(const LightField& light_field, const LfImageStore& store,
                            const RenderCamera& frame, const Ray& ray, ThreadPool& pool);

// The focus distance with which the frame's focus plane, tilted as it is, holds the point.
double FocusDistanceThrough(const RenderCamera& frame, const Vec3& point_world);

}  // namespace lf
