// What a ray would have recorded, interpolated between rebinned rays near it (thesis Eq. 4.5, 4.6):
//
//   L = sum w_i L_i / sum w_i,   w_i = exp(-|l - l_i|^2 / 2 sigma_st^2 - |p - p_i|^2 / 2
//   sigma_uv^2)
//
// with l where the ray passes the lens and p where it meets the plate, over the rays with
// |l - l_i|^2 / sigma_st^2 + |p - p_i|^2 / sigma_uv^2 <= kReach_sigmas^2, or the k nearest by that
// measure. (The factor before Eq. 4.5's exponentials is the same for all and cancels.)
//
// By a k-d tree (nanoflann): the thesis's way, for single rays, and the judge of splat.h.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "lf/core/geometry.h"
#include "lf/rebinning/frame_rays.h"

namespace lf {

struct QueryKernel {
  double sigma_st_w = 0;
  double sigma_uv_px = 0;
};
inline constexpr double kReach_sigmas = 3;

// What a sum of rays is: the sum of weights, and that of weighted values.
struct QuerySum {
  double weight = 0;
  std::array<double, 3> rgb = {};
};

class RayQuery {
 public:
  // Keeps the rays, not copied.
  RayQuery(std::span<const FrameRay> rays, const QueryKernel& kernel);
  ~RayQuery();
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  QuerySum WithinReach(const Vec2& lens_point, const Vec2& position_px) const;
  // Weights are those of Eq. 4.5 but for a factor.
  QuerySum Nearest(const Vec2& lens_point, const Vec2& position_px, size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace lf
