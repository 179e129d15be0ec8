// A scene as light: the radiance along any ray, in closed form (an analytic ray caster).
//
// Mirrors and glass are followed; diffuse surfaces receive lamps with soft shadows and the room's
// light (lighting.h). Nothing is random: the same ray has the same radiance always, from any
// thread, which is what makes light field and thin-lens frames pictures of one world.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/camera/ray.h"
#include "lf/synthetic/footprint.h"
#include "lf/synthetic/glows.h"
#include "lf/synthetic/lighting.h"
#include "lf/synthetic/scene_description.h"
#include "lf/synthetic/shapes.h"

namespace lf {

class Scene {
 public:
  // Material indices must exist; only spheres are of glass, only panels shine.
  explicit Scene(SceneDescription description);

  // Linear RGB. `ray.direction` may have any length but 0; lamps and textures are averaged over
  // `footprint`, whose lengths are those of a ray of unit length.
  Rgb RadianceAlong(const Ray& ray, const Footprint& footprint = {}) const;

  // What rays within a cone may meet first. Looking along many of them with it in hand gives the
  // same light sooner. The cone must hold the rays with kGlowReach widths of their
  // footprints (glows.h).
  struct Sector {
    std::vector<uint32_t> spheres;
    std::vector<uint32_t> glows;
  };
  Sector SectorOf(const Cone& cone) const;

  // The radiance with what was seen first, for deciding where more rays are due. `sector`: one
  // that holds the ray, or null.
  struct Sight {
    Rgb radiance = Rgb::Zero();
    uint32_t shape = Hit::kNothing;
  };
  Sight Look(const Ray& ray, const Footprint& footprint, const Sector* sector = nullptr) const;

 private:
  struct Beam {
    Ray ray;  // unit direction
    Footprint footprint;
    double weight = 1;  // share of it that reaches the eye
    int depth = 0;      // mirrors and glass passed
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
