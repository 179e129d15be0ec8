// SPDX-License-Identifier: Apache-2.0
// A scene as a light source: computes the radiance along any ray in closed form (an analytic ray
// caster).
//
// Rays are followed through mirrors and glass. Diffuse surfaces receive light from lamps, with soft
// shadows, and from the room (lighting.h). Nothing is random: a ray has the same radiance each time
// and in every thread. Therefore a light field and thin-lens frames show the same world.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/light_field/synthetic/footprint.h"
#include "lf/light_field/synthetic/glows.h"
#include "lf/light_field/synthetic/lighting.h"
#include "lf/light_field/synthetic/scene_description.h"
#include "lf/light_field/synthetic/shapes.h"

namespace lf {

class Scene {
 public:
  // Material indices must exist. Only spheres may have kGlass, only panels may have kLight.
  explicit Scene(SceneDescription description);

  // Returns the radiance as linear RGB. `ray.direction` may have any length but 0. Glows and
  // textures are averaged over `footprint`, whose lengths are measured as if the direction had unit
  // length.
  Rgb RadianceAlong(const Ray& ray, const Footprint& footprint = {}) const;

  // The indices of the spheres that rays within a cone may hit first, and of the glows that these
  // rays may pass. With a sector, SightAlong() returns the same light faster. The cone must contain
  // the rays and kGlowReach widths of their footprints around them (glows.h).
  struct Sector {
    std::vector<uint32_t> spheres;
    std::vector<uint32_t> glows;
  };
  Sector SectorOf(const Cone& cone) const;

  // The radiance along a ray, and the shape that the ray hits first. Different shapes in
  // neighbouring pixels tell where more rays are needed.
  struct Sight {
    Rgb radiance = Rgb::Zero();
    uint32_t shape = Hit::kNothing;
    // Distance from the origin to the first hit, if the direction had unit length; infinity if
    // there is none.
    double distance = std::numeric_limits<double>::infinity();
  };
  // `sector` is a sector whose cone contains the ray, or null.
  Sight SightAlong(const Ray& ray, const Footprint& footprint,
                   const Sector* sector = nullptr) const;

 private:
  struct Beam {
    Ray ray;  // unit direction
    Footprint footprint;
    double weight = 1;  // share of the beam's light that reaches the camera
    int depth = 0;      // number of reflections and glass spheres on the way from the camera
    const Sector* sector = nullptr;
  };
  struct Place;  // a point on a surface (scene.cc)

  Rgb Follow(const Beam& beam, Hit* first) const;
  Place PlaceOf(const Beam& beam, const Hit& hit) const;
  Rgb Reflection(const Beam& beam, const Place& place, double share) const;
  Rgb ThroughGlass(const Beam& beam, const Place& place) const;
  static Vec2 PlaceOnPattern(const Place& place);
  Rgb DiffuseRadiance(const Place& place) const;
  Rgb RoomRadiance(const Vec3& direction) const;

  std::vector<Material> materials_;
  Shapes shapes_;
  Glows glows_;
  Lighting lighting_;
  Room room_;
};

}  // namespace lf
