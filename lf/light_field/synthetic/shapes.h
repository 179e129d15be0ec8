// SPDX-License-Identifier: Apache-2.0
// Intersects rays with spheres and panels, and finds the first shape that a ray hits.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/core/geometry.h"
#include "lf/light_field/synthetic/ball_blocks.h"
#include "lf/light_field/synthetic/scene_description.h"

namespace lf {

// Smallest distance of a hit from the origin of a ray, in world units. Without this limit, a ray
// that leaves a surface would hit this surface again.
inline constexpr double kLeastLambda = 1e-7;

// Returns the distance along `ray`, whose direction has unit length, to the first point of the
// sphere beyond kLeastLambda. If the ray starts inside, this is the point where it leaves the
// sphere. nullopt if there is no such point.
std::optional<double> Intersect(const Ray& ray, const Sphere& sphere);

// A panel with values that are computed once for the intersection tests of all rays.
struct PanelPlane {
  explicit PanelPlane(const Panel& panel);

  // Returns the position of a point in units of the half axes. On the panel, both numbers are
  // within [-1, 1].
  Vec2 PlaceOf(const Vec3& point_world) const {
    const Vec3 offset = point_world - centre_world;
    return {offset.dot(right_per_w), offset.dot(up_per_w)};
  }

  Vec3 centre_world = Vec3::Zero();
  Vec3 normal_world = Vec3::UnitZ();  // unit length
  double offset_w = 0;                // normal_world . centre_world
  Vec3 right_per_w = Vec3::Zero();    // half_right_w of Panel, divided by its squared length
  Vec3 up_per_w = Vec3::Zero();       // half_up_w of Panel, divided by its squared length
  double half_right_w = 1;            // lengths of the half axes
  double half_up_w = 1;
  bool is_disk = false;
  uint32_t material = 0;
};

// Returns the distance along `ray`, whose direction has unit length, to a panel beyond
// kLeastLambda, on either side of the panel; nullopt if the ray misses it.
std::optional<double> Intersect(const Ray& ray, const PanelPlane& panel);

// The first point where a ray meets a shape; kNothing if it meets none. Shapes are numbered: first
// the spheres, then the panels.
struct Hit {
  double lambda = std::numeric_limits<double>::infinity();
  uint32_t shape = kNothing;

  static constexpr uint32_t kNothing = ~uint32_t{0};
  explicit operator bool() const { return shape != kNothing; }
};

// The spheres and panels of a scene.
class Shapes {
 public:
  Shapes(std::vector<Sphere> spheres, const std::vector<Panel>& panels);

  // Returns the first hit of the ray, whose direction must have unit length. `among` has the
  // indices of the spheres that are considered; null: all spheres are. Panels are always
  // considered.
  Hit FirstHit(const Ray& ray, const std::vector<uint32_t>* among = nullptr) const;

  // Returns the indices of all spheres that reach into the cone, and perhaps of some others.
  std::vector<uint32_t> SpheresNear(const Cone& cone) const;

  const std::vector<Sphere>& spheres() const { return spheres_; }
  // Returns the sphere with this shape number; null if the number is that of a panel.
  const Sphere* SphereOf(uint32_t shape) const {
    return shape < spheres_.size() ? &spheres_[shape] : nullptr;
  }
  const PanelPlane& PanelOf(uint32_t shape) const { return panels_[shape - spheres_.size()]; }

 private:
  std::vector<Sphere> spheres_;
  std::vector<PanelPlane> panels_;
  BallBlocks balls_;
};

}  // namespace lf
