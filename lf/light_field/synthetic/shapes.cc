// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lf {
std::optional<double> Intersect(const Ray& ray, const Sphere& sphere) {
  const Vec3 from_centre = ray.origin - sphere.centre_world;
  const double half_b = from_centre.dot(ray.direction);
  const double discriminant =
      half_b * half_b - from_centre.squaredNorm() + sphere.radius_w * sphere.radius_w;
  if (discriminant < 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  if (-half_b - root > kLeastLambda) return -half_b - root;
  if (-half_b + root > kLeastLambda) return -half_b + root;
  return std::nullopt;
}

PanelPlane::PanelPlane(const Panel& panel)
    : centre_world(panel.centre_world),
      normal_world(panel.half_right_w.cross(panel.half_up_w).normalized()),
      offset_w(normal_world.dot(panel.centre_world)),
      right_per_w(panel.half_right_w / panel.half_right_w.squaredNorm()),
      up_per_w(panel.half_up_w / panel.half_up_w.squaredNorm()),
      half_right_w(panel.half_right_w.norm()),
      half_up_w(panel.half_up_w.norm()),
      is_disk(panel.is_disk),
      material(panel.material) {}

std::optional<double> Intersect(const Ray& ray, const PanelPlane& panel) {
  const double along = panel.normal_world.dot(ray.direction);
  const double height_w = panel.offset_w - panel.normal_world.dot(ray.origin);
  if (!(along * height_w > 0)) return std::nullopt;  // the ray does not approach the plane
  const double lambda = height_w / along;
  if (lambda <= kLeastLambda) return std::nullopt;
  const Vec2 place = panel.PlaceOf(ray.At(lambda));
  const bool inside = panel.is_disk ? place.squaredNorm() <= 1 : place.cwiseAbs().maxCoeff() <= 1;
  return inside ? std::optional(lambda) : std::nullopt;
}

Shapes::Shapes(std::vector<Sphere> spheres, const std::vector<Panel>& panels)
    : spheres_(std::move(spheres)), panels_(panels.begin(), panels.end()) {
  std::vector<Ball> balls;
  for (const Sphere& sphere : spheres_) balls.push_back({sphere.centre_world, sphere.radius_w});
  balls_ = BallBlocks(balls);
}

Hit Shapes::FirstHit(const Ray& ray, const std::vector<uint32_t>* among) const {
  Hit hit;
  const auto keep_nearest = [&hit](const std::optional<double>& lambda, uint32_t shape) {
    if (lambda && *lambda < hit.lambda) hit = {*lambda, shape};
  };
  auto shape = static_cast<uint32_t>(spheres_.size());
  for (const PanelPlane& panel : panels_) keep_nearest(Intersect(ray, panel), shape++);
  const auto try_sphere = [&](uint32_t i) { keep_nearest(Intersect(ray, spheres_[i]), i); };
  if (among)
    std::for_each(among->begin(), among->end(), try_sphere);
  else
    balls_.ForEachNear({ray.origin, ray.direction, hit.lambda}, try_sphere);
  return hit;
}

std::vector<uint32_t> Shapes::SpheresNear(const Cone& cone) const {
  std::vector<uint32_t> spheres;
  balls_.ForEachNear(cone, [&spheres](uint32_t i) { spheres.push_back(i); });
  return spheres;
}

}  // namespace lf
