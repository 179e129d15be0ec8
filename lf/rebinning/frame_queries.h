// What one frame asks rebinned rays for: a ray for each element and lens point, all of them or, in
// some parts of the plate, some.
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
  std::optional<PointShares> shares;  // none: all of all points

  // Whether there is any.
  bool AsksForAny() const;
};

}  // namespace lf
