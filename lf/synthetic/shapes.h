// Rays against spheres and panels, and the first of many that a ray meets.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/core/geometry.h"
#include "lf/synthetic/ball_blocks.h"
#include "lf/synthetic/scene_description.h"

namespace lf {

// Nearer than this a ray meets nothing: it has just left that surface.
inline constexpr double kLeastLambda = 1e-7;

// Distance along `ray`, whose direction has unit length, to the first point of the sphere at more
// than kLeastLambda: the outside seen from outside, the inside from within.
std::optional<double> Intersect(const Ray& ray, const Sphere& sphere);

// A panel with what every ray would compute anew.
struct PanelPlane {
  explicit PanelPlane(const Panel& panel);

  // The place on the panel in units of its half axes: inside it both are within [-1, 1].
  Vec2 PlaceOf(const Vec3& point_world) const {
    const Vec3 offset = point_world - centre_world;
    return {offset.dot(right_per_w), offset.dot(up_per_w)};
  }

  Vec3 centre_world = Vec3::Zero();
  Vec3 normal_world = Vec3::UnitZ();  // unit length
  double offset_w = 0;                // normal . centre
  Vec3 right_per_w = Vec3::Zero();    // half axis over its squared length
  Vec3 up_per_w = Vec3::Zero();
  double half_right_w = 1;  // lengths of the half axes
  double half_up_w = 1;
  bool is_disk = false;
  uint32_t material = 0;
};

// The same for a panel, on both of its sides.
std::optional<double> Intersect(const Ray& ray, const PanelPlane& panel);

// Where a ray ends. Spheres are numbered first, then panels.
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

  // The direction must have unit length. `among`: the spheres that alone come into question, null
  // for all; panels always do.
  Hit FirstHit(const Ray& ray, const std::vector<uint32_t>* among = nullptr) const;

  // The spheres that reach into the cone, and perhaps some that do not.
  std::vector<uint32_t> SpheresNear(const Cone& cone) const;

  const std::vector<Sphere>& spheres() const { return spheres_; }
  // Null for a panel.
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
