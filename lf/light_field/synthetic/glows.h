// SPDX-License-Identifier: Apache-2.0
// The light of the glows that a ray passes: soft spots of light in the picture (Glow).
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/light_field/synthetic/ball_blocks.h"
#include "lf/light_field/synthetic/footprint.h"
#include "lf/light_field/synthetic/scene_description.h"

namespace lf {

// Number of radii from the centre of a glow beyond which it counts as dark: exp(-3.2^2) = 4e-5.
inline constexpr double kGlowReach = 3.2;

class Glows {
 public:
  explicit Glows(std::vector<Glow> glows);

  // Returns the light that all glows at distances from 0 to `lambda_end` along the ray add to it,
  // averaged over its footprint. The direction must have unit length. `among` has the indices of
  // the glows that are considered; null: all glows are.
  Rgb Along(const Ray& ray, const Footprint& footprint, double lambda_end,
            const std::vector<uint32_t>* among = nullptr) const;

  // Returns the indices of all glows that reach into the cone with kGlowReach radii, and perhaps of
  // some others.
  std::vector<uint32_t> Near(const Cone& cone) const;

 private:
  bool MayMeet(const Ray& ray, const Footprint& footprint, double lambda_end) const;

  std::vector<Glow> glows_;
  Eigen::AlignedBox3d bounds_;  // bounding box of all glows
  BallBlocks balls_;
};

}  // namespace lf
