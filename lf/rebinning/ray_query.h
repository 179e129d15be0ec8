// SPDX-License-Identifier: Apache-2.0
// The radiance of a ray, interpolated between the rebinned rays near it (thesis Eq. 4.5, 4.6):
//
//   L   = sum w_i L_i / sum w_i
//   w_i = exp(-|l - l_i|^2 / 2 sigma_st^2 - |p - p_i|^2 / 2 sigma_uv^2)
//
// Here l is the queried ray's point on the lens and p its position on the plate; L_i, l_i and p_i
// are radiance, point and position of the rebinned ray i. The sums run over the rebinned rays with
// |l - l_i|^2 / sigma_st^2 + |p - p_i|^2 / sigma_uv^2 <= kReach_sigmas^2, or over the k rays that
// are nearest by this measure. (The factor before Eq. 4.5's exponentials is the same for all rays
// and cancels.)
//
// Rays are found in a k-d tree (nanoflann), as in the thesis. RayQuery answers single queries, and
// is the reference that splat.h is compared with.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_rays.h"

namespace lf {

// Sigmas of the weights: on the lens, in world units, and on the plate, in elements.
struct QueryKernel {
  double sigma_st_w = 0;
  double sigma_uv_px = 0;
};
inline constexpr double kReach_sigmas = 3;

// Sum of the weights of some rays, and sum of their weighted values.
struct QuerySum {
  double weight = 0;
  std::array<double, 3> rgb = {};
};

class RayQuery {
 public:
  // Refers to `rays` without a copy: they must outlive this object.
  RayQuery(std::span<const FrameRay> rays, const QueryKernel& kernel);
  ~RayQuery();
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  // Returns the sums over the rays within reach of the query.
  QuerySum WithinReach(const Vec2& lens_point, const Vec2& position_px) const;
  // Returns the sums over the `count` nearest rays. All weights are multiplied by a common factor,
  // so that the largest is 1.
  QuerySum Nearest(const Vec2& lens_point, const Vec2& position_px, size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace lf
