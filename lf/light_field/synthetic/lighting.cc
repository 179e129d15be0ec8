// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/lighting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lf {
namespace {

// A sphere farther away than this number of its radii does not hide the room's light.
constexpr double kReach = 6;
// A point counts as lying on a sphere if it is at most this share of the sphere's radius above the
// surface of the sphere.
constexpr double kTouching = 1e-6;

// Returns the share of a lamp's light that passes one sphere on the way to a point. sine_lamp and
// sine_sphere are the sines of half the angles under which the point sees lamp and sphere; `cosine`
// is the cosine of the angle between their centres.
Rgb PassedBy(const Occluder& occluder, double sine_lamp, double sine_sphere, double cosine) {
  const double between = std::acos(std::min(1.0, cosine));
  const double sphere = std::asin(std::min(1.0, sine_sphere));
  const double hidden = HiddenShare(std::asin(std::min(1.0, sine_lamp)), sphere, between);
  if (!occluder.is_glass || hidden == 0) return Rgb::Constant(1 - hidden);
  // A glass sphere focuses three quarters of the light that its shadow lacks in a spot with 0.38 of
  // the shadow's radius, and spreads the share kSpread of that light evenly over the shadow.
  constexpr double kSpot = 0.38, kSpread = 0.12;
  const double t = between / (kSpot * sphere);
  const double gathered = kSpread + (0.75 / (kSpot * kSpot)) * std::exp(-t * t);
  return (1 - hidden) + hidden * gathered * occluder.colour;
}

// Returns the effective cosine of the angle of incidence of a lamp's light. The lamp may be partly
// below the horizon of the surface; then the result is a parabola of `cosine`, otherwise `cosine`
// itself.
double RisenCosine(double cosine, double sine_lamp) {
  if (cosine >= sine_lamp) return cosine;
  const double risen = std::max(0.0, cosine + sine_lamp);
  return risen * risen / (4 * sine_lamp);
}

}  // namespace

double HiddenShare(double a, double b, double c) {
  if (c >= a + b) return 0;
  const double most = b < a ? (b * b) / (a * a) : 1;
  const double inner = std::abs(a - b);
  if (c <= inner) return most;
  const double t = (c - inner) / (a + b - inner);
  return most * (1 - t * t * (3 - 2 * t));
}

Lighting::Lighting(std::vector<Lamp> lamps, std::vector<Occluder> occluders, const Rgb& ambient)
    : lamps_(std::move(lamps)), occluders_(std::move(occluders)), ambient_(ambient) {
  std::vector<Ball> balls;
  for (const Occluder& occluder : occluders_)
    balls.push_back({occluder.sphere.centre_world, occluder.sphere.radius_w});
  balls_ = BallBlocks(balls);
}

// Returns the share of the room's light that the spheres above the surface leave. Each sphere hides
// the share cosine * sine^2: the cosine of the angle between the normal and the direction to the
// sphere's centre, and the sine of half the angle under which the sphere is seen. The formula is
// exact for a single sphere wholly above the horizon. 1 / kReach^2 is subtracted from sine^2, so
// that the effect becomes 0 at kReach.
double Lighting::OpenShare(const Vec3& point_world, const Vec3& normal_world) const {
  double open = 1;
  balls_.ForEachAround(point_world, kReach, [&](uint32_t i) {
    const Sphere& sphere = occluders_[i].sphere;
    const Vec3 to_sphere = sphere.centre_world - point_world;
    const double cosine_length = normal_world.dot(to_sphere);
    const double length2 = to_sphere.squaredNorm();
    const double sine2 = sphere.radius_w * sphere.radius_w / length2 - 1 / (kReach * kReach);
    if (cosine_length <= 0 || sine2 <= 0) return;
    open *= 1 - std::min(1.0, cosine_length / std::sqrt(length2) * sine2);
  });
  return open;
}

Rgb Lighting::PassedLight(const Lamp& lamp, const Vec3& to_lamp, double distance,
                          const Vec3& point_world) const {
  const double sine_lamp = std::min(0.99, lamp.radius_w / distance);
  Rgb passed = Rgb::Ones();
  balls_.ForEachNear({point_world, to_lamp, distance, 0, sine_lamp}, [&](uint32_t i) {
    const Sphere& sphere = occluders_[i].sphere;
    const Vec3 to_sphere = sphere.centre_world - point_world;
    const double ahead = to_lamp.dot(to_sphere);
    const double length = to_sphere.norm();
    if (ahead <= 0 || ahead > distance || length < sphere.radius_w * (1 + kTouching)) return;
    passed *= PassedBy(occluders_[i], sine_lamp, sphere.radius_w / length, ahead / length);
  });
  return passed;
}

Rgb Lighting::DiffuseLight(const Vec3& point_world, const Vec3& normal_world) const {
  Rgb light = ambient_ * OpenShare(point_world, normal_world);
  for (const Lamp& lamp : lamps_) {
    const Vec3 offset = lamp.centre_world - point_world;
    const double distance2 = offset.squaredNorm();
    const double distance = std::sqrt(distance2);
    const Vec3 to_lamp = offset / distance;
    const double cosine = RisenCosine(normal_world.dot(to_lamp), lamp.radius_w / distance);
    if (cosine == 0) continue;
    light += lamp.power * PassedLight(lamp, to_lamp, distance, point_world) * (cosine / distance2);
  }
  return light;
}

}  // namespace lf
