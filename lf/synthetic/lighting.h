// The light on diffuse surfaces: lamps with soft shadows of spheres, and the light of the room.
#pragma once

#include <vector>

#include "lf/synthetic/ball_blocks.h"
#include "lf/synthetic/scene_description.h"

namespace lf {

// What throws shadows.
struct Occluder {
  Sphere sphere;
  bool is_glass = false;  // its shadow is coloured and has a bright spot in the middle
  Rgb colour = Rgb::Ones();
};

// All lamps and all that stands before them.
class Lighting {
 public:
  Lighting() = default;
  Lighting(std::vector<Lamp> lamps, std::vector<Occluder> occluders, const Rgb& ambient);

  // Light that a white diffuse surface at `point` reflects. Closed formulas, no random numbers: the
  // part of a lamp that a sphere hides is that of two discs on the sky; the spot in the shadow of
  // glass is a Gaussian, as bright as the light the shadow lacks. Spheres that touch the point hide
  // nothing of it: there the cosine has it already.
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

// Share of a disc of radius a on the sky hidden by one of radius b, centres c apart (angles).
double HiddenShare(double a, double b, double c);

}  // namespace lf
