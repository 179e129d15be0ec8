// SPDX-License-Identifier: Apache-2.0
// Finds the distance of the point that a person clicks on. A light field has no depths; therefore a
// plane sweep searches the ray of the click for a depth at which the LF images around it agree.
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
  // In [0, 1]: high if the LF images agree well at this depth, and much better than at other
  // depths.
  double certainty = 0;
  // The compared LF images, by ascending distances of their LF cameras from the ray's origin. LF
  // images that cannot be read, or show no tested point of the ray, are left out.
  std::vector<LfImageId> images;
};

// A pick below this certainty is a guess. Repeating patterns and outlines cause such picks.
inline constexpr double kLeastCertainty = 0.2;

// Returns the ray that an LF image records at the continuous position (x_px, y_px), with the lens
// distortion undone. None if no ray arrives at this position.
std::optional<Ray> RayOfLfPixel(const PinholeCamera& lf_camera, double x_px, double y_px);

// Returns the point of the scene that the ray meets. The compared LF cameras are around the ray's
// origin, within about the radius of the frame's lens, because the disparity between such cameras
// equals the blur of the lens. If fewer than nine are that near, farther ones are compared too.
//   ray    starts at the lens centre of `frame`, or at an LF camera
//   store  a store with Mosaics::kToRgb
// kInput, in words for the person who clicked: too few LF cameras see the point, it has no texture,
// or the LF images agree on no depth. Errors of store.Load() if too few LF images can be read, or
// if the machine lacks something (kOutput).
Result<FocusPick> FindFocus(const LightField& light_field, const LfImageStore& store,
                            const RenderCamera& frame, const Ray& ray, ThreadPool& pool);

// Returns the focus distance with which the focus plane of the frame, tilted as in `frame`,
// contains the point.
double FocusDistanceThrough(const RenderCamera& frame, const Vec3& point_world);

}  // namespace lf
