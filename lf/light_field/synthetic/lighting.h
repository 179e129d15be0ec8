// SPDX-License-Identifier: Apache-2.0
// The light on diffuse surfaces. It comes from lamps, with soft shadows of spheres, and from the
// ambient light of the room.
#pragma once

#include <vector>

#include "lf/light_field/synthetic/ball_blocks.h"
#include "lf/light_field/synthetic/scene_description.h"

namespace lf {

// A sphere that casts shadows.
struct Occluder {
  Sphere sphere;
  bool is_glass = false;     // glass casts a coloured shadow with a bright spot in the middle
  Rgb colour = Rgb::Ones();  // colour of the light in the shadow of glass
};

// All lamps, and all spheres that may hide them.
class Lighting {
 public:
  Lighting() = default;
  Lighting(std::vector<Lamp> lamps, std::vector<Occluder> occluders, const Rgb& ambient);

  // Returns the light that a white diffuse surface at the point reflects. The normal has unit
  // length. The light is computed by closed formulas, without random numbers. The share of a lamp
  // that a sphere hides is computed as for two discs on the sky. The spot in the shadow of glass is
  // a Gaussian with three quarters of the light that the shadow lacks. A sphere that the point lies
  // on hides nothing, because the cosine of the light's angle to the normal already accounts for
  // it.
  Rgb DiffuseLight(const Vec3& point_world, const Vec3& normal_world) const;

 private:
  double OpenShare(const Vec3& point_world, const Vec3& normal_world) const;
  Rgb PassedLight(const Lamp& lamp, const Vec3& to_lamp, double distance,
                  const Vec3& point_world) const;

  std::vector<Lamp> lamps_;
  std::vector<Occluder> occluders_;
  BallBlocks balls_;
  Rgb ambient_ = Rgb::Zero();
};

// Returns approximately the share of a disc of radius a on the sky that is hidden by a disc of
// radius b, whose centre is c away. a, b and c are angles in radians.
double HiddenShare(double a, double b, double c);

}  // namespace lf
