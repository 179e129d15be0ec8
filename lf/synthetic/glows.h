// The small lamps that a ray passes.
#pragma once

#include <vector>

#include "lf/camera/ray.h"
#include "lf/synthetic/ball_blocks.h"
#include "lf/synthetic/footprint.h"
#include "lf/synthetic/scene_description.h"

namespace lf {

class Glows {
 public:
  explicit Glows(std::vector<Glow> glows);

  // The light that all lamps before `lambda_end` bring to the ray, averaged over its footprint.
  // The direction must have unit length.
  Rgb Along(const Ray& ray, const Footprint& footprint, double lambda_end) const;

 private:
  bool MayMeet(const Ray& ray, const Footprint& footprint, double lambda_end) const;

  std::vector<Glow> glows_;
  Eigen::AlignedBox3d bounds_;  // of all that shines
  BallBlocks balls_;
};

}  // namespace lf
