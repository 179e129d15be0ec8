// SPDX-License-Identifier: Apache-2.0
// The parts of a synthetic scene, as plain values. lf::Scene (scene.h) computes its light.
//
// World units are metres (unit_m = 1), and y points down: the normal of a table top, half_right x
// half_up, points to -y. Radiance is linear light with sRGB primaries; 1 is display white.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/light_field/synthetic/pattern.h"

namespace lf {

using Rgb = Eigen::Array3d;

enum class Finish : uint8_t {
  kDiffuse,  // Lambertian under a clear coat that reflects Material::coat times as much as glass
  kMirror,   // reflects the share Material::colour of the light
  kGlass,    // refracts; the share Material::colour of the light is left after a path of one radius
  kLight,    // emits the radiance Material::colour, which fades out towards the rim of the panel
};

struct Material {
  Finish finish = Finish::kDiffuse;
  Rgb colour = Rgb::Constant(0.5);
  Rgb second_colour = Rgb::Constant(0.5);  // colour where the pattern is 1; kDiffuse only
  Pattern pattern;
  double coat = 0;                // strength of the clear coat: 0 matte, 1 polished
  double refractive_index = 1.5;  // refractive index of glass and of the coat
  // Angle by which the material widens the footprint of a ray that it reflects or refracts, like an
  // imperfect polish. It keeps the tiny images of glows in balls from sparkling.
  double haze_rad = 0;
};

struct Sphere {
  Vec3 centre_world = Vec3::Zero();
  double radius_w = 1;
  uint32_t material = 0;  // index into SceneDescription::materials
};

// A flat piece, visible from both sides: the points centre + a half_right + b half_up with |a|, |b|
// <= 1; for a disk, a^2 + b^2 <= 1. Its pattern is placed in world units, with the centre as origin
// (kBars and kLetters: the upper left corner).
struct Panel {
  Vec3 centre_world = Vec3::Zero();
  Vec3 half_right_w = Vec3::UnitX();
  Vec3 half_up_w = -Vec3::UnitY();
  bool is_disk = false;
  uint32_t material = 0;
};

// A soft ball of light that is seen in the picture and hides nothing. A ray that passes its
// centre at distance b receives colour exp(-(b / radius)^2). The average of this light over a round
// Gaussian footprint is again a Gaussian, so that a glow far smaller than a pixel loses no light
// and does not flicker.
struct Glow {
  Vec3 centre_world = Vec3::Zero();
  double radius_w = 0.005;
  Rgb colour = Rgb::Constant(1);  // radiance at the centre; may be far above 1
};

// A light that falls on diffuse surfaces and is itself invisible (a kLight panel at the same
// position can show it). Spheres cast shadows, which are softer for larger lamps; panels cast none.
struct Lamp {
  Vec3 centre_world = Vec3::Zero();
  double radius_w = 0.1;
  Rgb power = Rgb::Constant(1);  // radiance of a white surface that faces the lamp at distance 1
};

// A soft spot of light in the distant room (Room). In a direction at the angle a from
// direction_world, it adds the radiance colour * exp(sharpness (cos(a) - 1)).
struct RoomSpot {
  Vec3 direction_world = Vec3::UnitZ();  // unit length
  double sharpness = 10;
  Rgb colour = Rgb::Constant(1);
};
// The light of the distant room: a blend from `floor` to `ceiling` by the height of the direction,
// and soft spots.
struct Room {
  Rgb floor = Rgb::Zero();
  Rgb ceiling = Rgb::Zero();
  std::vector<RoomSpot> spots;
  Rgb ambient = Rgb::Zero();  // light on diffuse surfaces from all directions; less near spheres
};

struct SceneDescription {
  std::vector<Material> materials;
  std::vector<Sphere> spheres;
  std::vector<Panel> panels;
  std::vector<Glow> glows;
  std::vector<Lamp> lamps;
  Room room;
};

}  // namespace lf
