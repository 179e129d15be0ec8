// The queries of one frame: the rays that it interpolates between rebinned rays, one for each
// element and lens point. Parts of the plate may query only some of the lens points.
#pragma once

#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/rebinning/lens_points.h"
#include "lf/rebinning/ray_query.h"
#include "lf/rebinning/splat.h"

namespace lf {

// How densely the light field was recorded around one frame.
struct LfSampling {
  double camera_distance_w = 0;      // distance between neighbouring LF cameras
  double pixel_rad = 0;              // angle that one LF pixel sees
  Vec3 middle_world = Vec3::Zero();  // mean position of the LF cameras
};

struct FrameQueries {
  RenderCamera camera;
  LfSampling sampling;
  LensPointSets points;
  QueryKernel kernel;
  std::optional<PointShares> shares;  // none: every element queries all points

  // True if an element queries a ray.
  bool AsksForAny() const;
};

}  // namespace lf
