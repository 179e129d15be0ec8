// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/core/check.h"
#include "lf/light_field/synthetic/optics.h"

namespace lf {
namespace {

// A light path ends after kDepthLimit reflections and glass spheres, or if less than kLeastWeight
// of its light would reach the camera.
constexpr int kDepthLimit = 4;
constexpr double kLeastWeight = 0.012;

}  // namespace

struct Scene::Place {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // points against the ray
  double cosine = 1;           // cosine of the angle between ray and normal
  Footprint footprint;         // footprint of the beam, starting at the point
  const Sphere* sphere = nullptr;
  const PanelPlane* panel = nullptr;
  const Material* material = nullptr;
};

Scene::Scene(SceneDescription d)
    : materials_(std::move(d.materials)),
      shapes_(std::move(d.spheres), d.panels),
      glows_(std::move(d.glows)),
      room_(std::move(d.room)) {
  for (const Panel& panel : d.panels) {
    LF_CHECK(panel.material < materials_.size());
    LF_CHECK(materials_[panel.material].finish != Finish::kGlass);
  }
  std::vector<Occluder> occluders;
  for (const Sphere& sphere : shapes_.spheres()) {
    LF_CHECK(sphere.material < materials_.size());
    const Material& material = materials_[sphere.material];
    LF_CHECK(material.finish != Finish::kLight);
    occluders.push_back({sphere, material.finish == Finish::kGlass, material.colour});
  }
  lighting_ = Lighting(std::move(d.lamps), std::move(occluders), room_.ambient);
}

Rgb Scene::RadianceAlong(const Ray& ray, const Footprint& footprint) const {
  return SightAlong(ray, footprint).radiance;
}

Scene::Sector Scene::SectorOf(const Cone& cone) const {
  return {shapes_.SpheresNear(cone), glows_.Near(cone)};
}

Scene::Sight Scene::SightAlong(const Ray& ray, const Footprint& footprint,
                               const Sector* sector) const {
  Hit first;
  const Rgb radiance =
      Follow({{ray.origin, ray.direction.normalized()}, footprint, 1, 0, sector}, &first);
  return {radiance, first.shape, first.lambda};
}

Scene::Place Scene::PlaceOf(const Beam& beam, const Hit& hit) const {
  Place place;
  place.point = beam.ray.At(hit.lambda);
  place.sphere = shapes_.SphereOf(hit.shape);
  if (place.sphere) {
    place.normal = (place.point - place.sphere->centre_world) / place.sphere->radius_w;
    place.material = &materials_[place.sphere->material];
  } else {
    place.panel = &shapes_.PanelOf(hit.shape);
    place.normal = place.panel->normal_world;
    place.material = &materials_[place.panel->material];
  }
  place.cosine = -place.normal.dot(beam.ray.direction);
  if (place.cosine < 0) {
    place.normal = -place.normal;
    place.cosine = -place.cosine;
  }
  place.footprint = beam.footprint.From(hit.lambda);
  return place;
}

Rgb Scene::Follow(const Beam& beam, Hit* first) const {
  const Sector* const sector = beam.sector;
  const Hit hit = shapes_.FirstHit(beam.ray, sector ? &sector->spheres : nullptr);
  if (first) *first = hit;
  const Rgb glow =
      glows_.Along(beam.ray, beam.footprint, hit.lambda, sector ? &sector->glows : nullptr);
  if (!hit) return glow + RoomRadiance(beam.ray.direction);
  const Place place = PlaceOf(beam, hit);
  const Material& material = *place.material;
  switch (material.finish) {
    case Finish::kMirror:
      return glow + material.colour * Reflection(beam, place, 1);
    case Finish::kGlass:
      return glow + ThroughGlass(beam, place);
    case Finish::kDiffuse: {
      if (material.coat == 0) return glow + DiffuseRadiance(place);
      const double share = material.coat * Reflectance(place.cosine, material.refractive_index);
      return glow + (1 - share) * DiffuseRadiance(place) + share * Reflection(beam, place, share);
    }
    case Finish::kLight: {
      const Vec2 at = place.panel->PlaceOf(place.point);
      const auto fall = [](double t) { return 1 - (t * t) * (t * t) * (t * t) * (t * t); };
      const double rim = fall(at.x()) * fall(at.y());
      return glow + material.colour * std::max(0.0, rim);
    }
  }
  return glow;
}

// Returns the light that arrives from the mirrored direction. The caller multiplies it by `share`,
// the share that the surface mirrors. A sphere of radius R spreads the beam: its focal length is
// -R/2 times the cosine of the angle of incidence.
Rgb Scene::Reflection(const Beam& beam, const Place& place, double share) const {
  Beam next{{place.point, Reflected(beam.ray.direction, place.normal)},
            place.footprint,
            beam.weight * share,
            beam.depth + 1,
            nullptr};
  if (next.depth > kDepthLimit || next.weight < kLeastWeight) return Rgb::Zero();
  next.footprint.spread += place.material->haze_rad;
  if (place.sphere) {
    constexpr double kGrazing = 0.1;
    next.footprint.spread +=
        2 * place.footprint.width_w / (place.sphere->radius_w * std::max(kGrazing, place.cosine));
  }
  return Follow(next, nullptr);
}

// Returns the light that comes from a glass sphere: the light that the surface mirrors, and the
// light of a beam that is followed into the sphere, along the chord, and out. By symmetry, a ray
// leaves a sphere at the angle at which it entered. Therefore the ray always gets out, and loses
// the same share of its light once more. Internal reflections are left out.
Rgb Scene::ThroughGlass(const Beam& beam, const Place& place) const {
  LF_CHECK(place.sphere != nullptr);  // the constructor rejects panels of glass
  const Material& glass = *place.material;
  const Sphere& sphere = *place.sphere;
  const double share = Reflectance(place.cosine, glass.refractive_index);
  const Rgb mirrored = share * Reflection(beam, place, share);
  const double passing = (1 - share) * (1 - share);
  if (beam.depth >= kDepthLimit || passing * beam.weight < kLeastWeight) return mirrored;
  const Vec3 inside = *Refracted(beam.ray.direction, place.normal, 1 / glass.refractive_index);
  const double chord_w = 2 * sphere.radius_w * -inside.dot(place.normal);
  const Vec3 exit = place.point + chord_w * inside;
  const Vec3 exit_normal = (sphere.centre_world - exit) / sphere.radius_w;
  const std::optional<Vec3> direction = Refracted(inside, exit_normal, glass.refractive_index);
  if (!direction) return mirrored;  // only due to rounding errors at the very rim
  // The sphere is treated as a thin ball lens of focal length n R / (2 (n - 1)), with refractive
  // index n and radius R, which narrows the footprint. Haze widens it, whatever the sign of the
  // spread.
  const double focal_w =
      glass.refractive_index * sphere.radius_w / (2 * (glass.refractive_index - 1));
  double spread = place.footprint.spread - place.footprint.width_w / focal_w;
  spread += std::copysign(glass.haze_rad, spread);
  const Beam next{
      {exit, *direction}, {place.footprint.width_w, spread}, passing * beam.weight, beam.depth + 1};
  const Rgb tint = glass.colour.pow(chord_w / sphere.radius_w);
  return mirrored + passing * tint * Follow(next, nullptr);
}

// Returns the position in the plane of the pattern that belongs to a point of a surface.
Vec2 Scene::PlaceOnPattern(const Place& place) {
  // The pattern is projected onto a sphere along a slanted direction, so that it has no poles and
  // no seam.
  if (place.sphere) {
    const Vec3 offset = place.point - place.sphere->centre_world;
    return {offset.x() + 0.5 * offset.z(), offset.y() - 0.4 * offset.z()};
  }
  const PatternKind kind = place.material->pattern.kind;
  Vec2 at = place.panel->PlaceOf(place.point);
  if (kind == PatternKind::kBars || kind == PatternKind::kLetters) at += Vec2(1, -1);
  return {at.x() * place.panel->half_right_w, at.y() * place.panel->half_up_w};
}

Rgb Scene::DiffuseRadiance(const Place& place) const {
  const Material& material = *place.material;
  Rgb colour = material.colour;
  if (material.pattern.kind != PatternKind::kPlain) {
    // A slanted footprint is long in only one direction; therefore its mean width is used.
    const double width_w =
        place.footprint.width_w / (kFootprintPerSide * std::sqrt(std::max(0.01, place.cosine)));
    const double second = PatternAt(material.pattern, PlaceOnPattern(place), width_w);
    colour += second * (material.second_colour - colour);
  }
  return colour * lighting_.DiffuseLight(place.point, place.normal);
}

Rgb Scene::RoomRadiance(const Vec3& direction) const {
  const double up = 0.5 - 0.5 * direction.y();
  Rgb light = room_.floor + up * up * (3 - 2 * up) * (room_.ceiling - room_.floor);
  for (const RoomSpot& spot : room_.spots) {
    const double exponent = spot.sharpness * (direction.dot(spot.direction_world) - 1);
    if (exponent > -12) light += spot.colour * std::exp(exponent);
  }
  return light;
}

}  // namespace lf
