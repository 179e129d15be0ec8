// SPDX-License-Identifier: Apache-2.0
// Tells how much of the frames of a moving camera LF cameras have recorded.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lf/camera/ray_through.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/focus/moves/shot.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The largest number of LF cameras that a coverage considers.
inline constexpr size_t kMostCoverageCameras = 400;

class MoveCoverage {
 public:
  //   cameras   LF cameras whose images count
  //   radius_w  an element counts as recorded if an LF camera sees its point on the focus plane
  //             through a lens of this radius
  // Refers to `shot`, which must live longer.
  MoveCoverage(const LightField& light_field, std::span<const LfImageId> cameras, const Shot& shot,
               double radius_w);

  // Returns the share of the elements of a frame, 0 to 1, that no LF camera has recorded. 81
  // elements are tested. The camera of the frame stands at `position_world` and looks at the
  // subject. The frame has the share `crop` of the width and height of Shot::frame.
  double Unseen(const Vec3& position_world, double crop) const;

 private:
  bool IsSeen(const PinholeCamera& frame, const Ray& ray) const;

  const Shot& shot_;
  Vec3 subject_world_;
  double radius_w_;
  std::vector<RayThrough> cameras_;
};

// Returns the coverage of a camera that moves up to `way_w` away from Shot::start. LF cameras count
// through the lens, or within the distance to the next LF camera if that is more. In dense captures
// only kMostCoverageCameras of them are considered, spread over all; the distance to the next one
// grows accordingly. Refers to `shot`, which must live longer.
MoveCoverage CoverageNear(const LightField& light_field, const Shot& shot, double way_w);

}  // namespace lf
