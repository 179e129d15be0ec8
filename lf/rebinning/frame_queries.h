// The queries of one frame: the rays that it interpolates between rebinned rays, one for each
// element and lens point. Parts of the plate may query only some of the lens points.
#pragma once

#include <optional>

#include "lf/camera/render_camera.h"
#include "lf/rebinning/lens_points.h"
#include "lf/rebinning/ray_query.h"
#include "lf/rebinning/splat.h"

namespace lf {

struct FrameQueries {
  RenderCamera camera;
  LensPointSets points;
  QueryKernel kernel;
  std::optional<PointShares> shares;  // none: every element queries all points

  // True if an element queries a ray.
  bool AsksForAny() const;
};

}  // namespace lf
