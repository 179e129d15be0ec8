// The rays that one frame asks rebinned rays for: one ray for each element and lens point. Parts of
// the plate may ask for a part of the lens points only.
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
  std::optional<PointShares> shares;  // none: every element asks for all points

  // True if an element asks for a ray.
  bool AsksForAny() const;
};

}  // namespace lf
