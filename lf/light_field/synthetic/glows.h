// The light of the small lamps (glows) that a ray passes.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/light_field/synthetic/ball_blocks.h"
#include "lf/light_field/synthetic/footprint.h"
#include "lf/light_field/synthetic/scene_description.h"

namespace lf {

// Number of radii from the centre of a lamp beyond which it counts as dark: exp(-3.2^2) = 4e-5.
inline constexpr double kGlowReach = 3.2;

class Glows {
 public:
  explicit Glows(std::vector<Glow> glows);

  // Returns the light that all lamps at distances below `lambda_end` add to the ray, averaged over
  // its footprint. The direction must have unit length. `among` lists the lamps that are
  // considered; null: all lamps are.
  Rgb Along(const Ray& ray, const Footprint& footprint, double lambda_end,
            const std::vector<uint32_t>* among = nullptr) const;

  // Returns the indices of all lamps that reach into the cone, and perhaps of some others.
  std::vector<uint32_t> Near(const Cone& cone) const;

 private:
  bool MayMeet(const Ray& ray, const Footprint& footprint, double lambda_end) const;

  std::vector<Glow> glows_;
  Eigen::AlignedBox3d bounds_;  // bounding box of all glows
  BallBlocks balls_;
};

}  // namespace lf
