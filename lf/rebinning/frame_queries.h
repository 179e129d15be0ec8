// SPDX-License-Identifier: Apache-2.0
// The queries of one frame: the rays that it interpolates between rebinned rays, one for each
// element and each lens point of the element's set (LensPointSets). Parts of the plate may query
// only some of the lens points.
#pragma once

#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/rebinning/lens_points.h"
#include "lf/rebinning/ray_query.h"
#include "lf/rebinning/splat.h"

namespace lf {

// How densely the light field was recorded around the lens of one frame. The LF cameras near the
// lens are those of ImagesNearLens() (render/hybrid/frame_sampling.h).
struct LfSampling {
  double camera_distance_w = 0;      // distance between neighbouring LF cameras around the lens
  double pixel_rad = 0;              // angle that one LF pixel sees: median near the lens
  Vec3 middle_world = Vec3::Zero();  // mean position of the LF cameras near the lens
};

struct FrameQueries {
  RenderCamera camera;
  LfSampling sampling;
  LensPointSets points;
  QueryKernel kernel;
  std::optional<PointShares> shares;  // none: every element queries all points of its set

  // True if an element queries a ray.
  bool AsksForAny() const;
};

}  // namespace lf
