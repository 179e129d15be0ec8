// SPDX-License-Identifier: Apache-2.0
// The still life: warm lights in a dark room, one large soft key light from the left, a cooler rim
// light from behind on the right. Colours are amber against teal, with rose as the accent.
#include <cmath>

#include "lf/core/random.h"
#include "lf/light_field/synthetic/built_in_scenes.h"

namespace lf {
namespace {

// Adds materials and spheres to a scene. Functions that add a material return its index.
class Table {
 public:
  explicit Table(SceneDescription& scene) : scene_(scene) {}

  uint32_t Add(const Material& material) {
    scene_.materials.push_back(material);
    return static_cast<uint32_t>(scene_.materials.size() - 1);
  }
  // Adds a sphere that lies on the table (y = 0).
  void Lay(double x, double z, double radius_w, uint32_t material) {
    scene_.spheres.push_back({{x, -radius_w, z}, radius_w, material});
  }
  uint32_t Glazed(const Rgb& colour) {
    Material material;
    material.colour = colour;
    material.coat = 1;
    return Add(material);
  }
  uint32_t Veined(const Rgb& colour, const Rgb& vein, double scale_w, uint64_t seed) {
    Material material;
    material.colour = colour;
    material.second_colour = vein;
    material.pattern = {PatternKind::kSwirl, scale_w, seed};
    material.coat = 1;
    return Add(material);
  }
  uint32_t Metal(const Rgb& colour) {
    Material material;
    material.finish = Finish::kMirror;
    material.haze_rad = 0.04;
    material.colour = colour;
    return Add(material);
  }
  uint32_t Glass(const Rgb& colour) {
    Material material;
    material.finish = Finish::kGlass;
    material.haze_rad = 0.012;
    material.colour = colour;
    return Add(material);
  }

 private:
  SceneDescription& scene_;
};

void AddTableTop(SceneDescription& scene, Table& table) {
  Material wood;
  wood.colour = {0.105, 0.044, 0.02};
  wood.second_colour = {0.022, 0.009, 0.005};
  wood.pattern = {PatternKind::kWood, 0.11, 7};
  wood.coat = 0.4;
  wood.haze_rad = 0.006;
  scene.panels.push_back({{0, 0, 0.2}, {1.5, 0, 0}, {0, 0, 1.0}, false, table.Add(wood)});
}

// Adds a white cloth at the position of a lamp, facing the middle of the table. All shiny objects
// reflect it.
void AddSoftBox(SceneDescription& scene, Table& table, const Vec3& centre, double half_width_w,
                double half_height_w, const Rgb& radiance) {
  Material cloth;
  cloth.finish = Finish::kLight;
  cloth.colour = radiance;
  const Vec3 forward = -centre.normalized();
  const Vec3 right = forward.cross(-Vec3::UnitY()).normalized();
  const Vec3 up = right.cross(forward);
  scene.panels.push_back(
      {centre, half_width_w * right, half_height_w * up, false, table.Add(cloth)});
}

void AddKeyAndRim(SceneDescription& scene, Table& table) {
  const Vec3 key(-0.72, -0.66, 0.12);
  scene.lamps.push_back({key, 0.16, Rgb(1.0, 0.82, 0.62) * 2.1});
  AddSoftBox(scene, table, key, 0.2, 0.24, Rgb(1.0, 0.86, 0.7) * 6);
  const Vec3 rim(0.8, -0.5, 0.75);
  scene.lamps.push_back({rim, 0.12, Rgb(0.6, 0.85, 1.0) * 0.7});
  AddSoftBox(scene, table, rim, 0.07, 0.3, Rgb(0.7, 0.9, 1.0) * 3);
}

void AddSpheres(Table& table) {
  const uint32_t clear = table.Glass({0.985, 0.99, 0.985});
  const uint32_t amber = table.Glass({0.97, 0.62, 0.16});
  const uint32_t sea = table.Glass({0.35, 0.85, 0.88});
  const uint32_t wine = table.Glass({0.9, 0.24, 0.22});
  const uint32_t steel = table.Metal({0.86, 0.87, 0.88});
  const uint32_t gold = table.Metal({0.98, 0.7, 0.3});
  const uint32_t teal = table.Glazed({0.006, 0.085, 0.1});
  const uint32_t rose = table.Glazed({0.3, 0.018, 0.022});
  const uint32_t ivory = table.Glazed({0.3, 0.235, 0.155});
  const uint32_t honey = table.Veined({0.75, 0.3, 0.04}, {0.8, 0.62, 0.36}, 0.02, 3);
  const uint32_t ocean = table.Veined({0.012, 0.13, 0.17}, {0.4, 0.6, 0.56}, 0.02, 4);

  table.Lay(0.125, -0.05, 0.082, clear);
  table.Lay(-0.165, 0.1, 0.072, steel);
  table.Lay(0.0, 0.27, 0.052, teal);
  table.Lay(0.36, 0.3, 0.062, gold);
  table.Lay(0.215, 0.52, 0.06, rose);
  table.Lay(-0.43, 0.42, 0.06, ivory);

  table.Lay(-0.1, -0.22, 0.027, amber);
  table.Lay(-0.035, -0.29, 0.015, steel);
  table.Lay(-0.035, -0.1, 0.021, honey);
  table.Lay(0.035, -0.24, 0.017, sea);
  table.Lay(0.2, -0.22, 0.019, ocean);
  table.Lay(-0.185, -0.1, 0.022, wine);
  table.Lay(0.262, -0.08, 0.017, gold);
  table.Lay(-0.06, 0.06, 0.02, gold);
  table.Lay(0.24, 0.16, 0.022, honey);
  table.Lay(-0.27, -0.04, 0.018, sea);
  table.Lay(-0.29, 0.26, 0.02, amber);
  table.Lay(-0.13, 0.42, 0.024, wine);
  table.Lay(0.15, -0.375, 0.015, wine);
  table.Lay(-0.192, -0.35, 0.014, honey);
}

// Adds glows on strings that sag between their nails. More than two thirds of the glows are golden.
void AddStringsOfLights(SceneDescription& scene) {
  const Rgb golden[] = {Rgb(1.0, 0.5, 0.14), Rgb(1.0, 0.4, 0.085), Rgb(1.0, 0.6, 0.26)};
  const Rgb rose(1.0, 0.17, 0.13), sea(0.1, 0.6, 0.58);
  struct String {
    Vec3 from, to;
    double sag_w;
    int count;
  };
  const String strings[] = {{{-1.7, -0.62, 1.5}, {-0.3, -0.56, 1.35}, 0.22, 13},
                            {{-0.3, -0.56, 1.35}, {1.75, -0.68, 1.5}, 0.36, 20},
                            {{-1.5, -0.3, 1.9}, {-0.75, -0.38, 1.7}, 0.12, 7},
                            {{-0.75, -0.38, 1.7}, {0.55, -0.36, 1.7}, 0.17, 12},
                            {{0.55, -0.36, 1.7}, {1.8, -0.42, 1.9}, 0.14, 10}};
  uint64_t lamp = 0;
  for (const String& string : strings)
    for (int i = 0; i < string.count; ++i, ++lamp) {
      const double t = (i + 0.25 + 0.5 * RandomUnit(11, 0, lamp)) / string.count;
      Vec3 place = string.from + t * (string.to - string.from);
      place.y() += 4 * string.sag_w * t * (1 - t) + 0.025 * (RandomUnit(11, 1, lamp) - 0.5);
      place.z() += 0.1 * (RandomUnit(11, 2, lamp) - 0.5);
      const double strength = 5 + 10 * RandomUnit(11, 3, lamp);
      const Rgb colour = lamp % 5 == 2   ? sea
                         : lamp % 7 == 3 ? rose
                                         : golden[RandomBits(11, 4, lamp) % std::size(golden)];
      scene.glows.push_back({place, 0.0125, strength * colour});
    }
}

void AddRoom(SceneDescription& scene) {
  scene.room.floor = {0.003, 0.0018, 0.0014};
  scene.room.ceiling = {0.004, 0.0026, 0.0028};
  scene.room.ambient = {0.045, 0.036, 0.034};
  scene.room.spots = {{Vec3(0.16, 0.0, 1).normalized(), 26, {0.075, 0.026, 0.009}},
                      {Vec3(-0.4, -0.02, 1).normalized(), 16, {0.01, 0.016, 0.017}},
                      {Vec3(0.5, -0.5, -0.8).normalized(), 6, {0.04, 0.06, 0.07}}};
}

}  // namespace

SceneDescription DescribeStillLife() {
  SceneDescription scene;
  Table table(scene);
  AddTableTop(scene, table);
  AddKeyAndRim(scene, table);
  AddSpheres(table);
  AddStringsOfLights(scene);
  AddRoom(scene);
  return scene;
}

}  // namespace lf
