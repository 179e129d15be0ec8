// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/glows.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lf {
Glows::Glows(std::vector<Glow> glows) : glows_(std::move(glows)) {
  std::vector<Ball> balls;
  for (const Glow& glow : glows_) {
    balls.push_back({glow.centre_world, kGlowReach * glow.radius_w});
    const Vec3 reach = Vec3::Constant(kGlowReach * glow.radius_w);
    bounds_.extend(glow.centre_world - reach).extend(glow.centre_world + reach);
  }
  balls_ = BallBlocks(balls);
}

// Returns true if the box around the ray touches the box around the glows. This test excludes the
// many rays that end on a table below the glows.
bool Glows::MayMeet(const Ray& ray, const Footprint& footprint, double lambda_end) const {
  if (glows_.empty()) return false;
  const double past_all = (bounds_.center() - ray.origin).norm() + bounds_.diagonal().norm();
  const double end = std::min(lambda_end, past_all);
  const Vec3 reach = Vec3::Constant(kGlowReach * std::max(footprint.At(0), footprint.At(end)));
  const Vec3 last = ray.At(end);
  return Eigen::AlignedBox3d(ray.origin.cwiseMin(last) - reach, ray.origin.cwiseMax(last) + reach)
      .intersects(bounds_);
}

Rgb Glows::Along(const Ray& ray, const Footprint& footprint, double lambda_end,
                 const std::vector<uint32_t>* among) const {
  Rgb light = Rgb::Zero();
  const auto add = [&](uint32_t i) {
    const Glow& glow = glows_[i];
    const Vec3 to_centre = glow.centre_world - ray.origin;
    const double lambda = to_centre.dot(ray.direction);
    if (lambda < 0 || lambda > lambda_end) return;
    const double passes2 = std::max(0.0, to_centre.squaredNorm() - lambda * lambda);
    const double width_w = footprint.At(lambda);
    const double own2 = glow.radius_w * glow.radius_w;
    const double wide2 = own2 + width_w * width_w;  // convolving Gaussians adds squared widths
    if (passes2 > kGlowReach * kGlowReach * wide2) return;
    light += glow.colour * (own2 / wide2 * std::exp(-passes2 / wide2));
  };
  if (among) {
    std::for_each(among->begin(), among->end(), add);
  } else if (MayMeet(ray, footprint, lambda_end)) {
    const double tangent = kGlowReach * std::abs(footprint.spread);
    balls_.ForEachNear({ray.origin, ray.direction, lambda_end, kGlowReach * footprint.width_w,
                        tangent / std::sqrt(1 + tangent * tangent)},
                       add);
  }
  return light;
}

std::vector<uint32_t> Glows::Near(const Cone& cone) const {
  std::vector<uint32_t> near;
  balls_.ForEachNear(cone, [&near](uint32_t i) { near.push_back(i); });
  return near;
}

}  // namespace lf
