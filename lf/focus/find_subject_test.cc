// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/find_subject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/random.h"
#include "lf/core/test_value_noise.h"
#include "lf/focus/focus_pick.h"

namespace lf {
namespace {

constexpr int kWidth = 240, kHeight = 160;
constexpr double kFocal_px = 260;

// Returns the light, 0 to 1, along a ray that LF image `id` records at a pixel; NaN: nothing is
// recorded.
using Light = std::function<double(const Ray& ray, LfImageId id, const Vec2& at_px)>;

class DrawnStore : public LfImageStore {
 public:
  DrawnStore(const LightField& field, Light light) : field_(field), light_(std::move(light)) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (id == broken) return failure;
    const PinholeCamera camera = field_.Camera(id);
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        const Vec2 at(rect.x_begin + x + 0.5, rect.y_begin + y + 0.5);
        const double light = light_(*RayOfLfPixel(camera, at.x(), at.y()), id, at);
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) =
              static_cast<uint16_t>(std::isnan(light) ? 0 : 65535 * std::clamp(light, 0., 1.));
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
        if (std::isnan(light)) pixels->Mask(x, y);
      }
    return {};
  }

  LfImageId broken{1000000};
  Error failure = InputError("drawn.png: not found");

 private:
  const LightField& field_;
  Light light_;
};

// Returns the light of a texture with details of a few pixels, on a plane at depth `depth_w`.
double Texture(const Ray& ray, double depth_w, uint64_t seed) {
  const Vec3 point = ray.At((depth_w - ray.origin.z()) / ray.direction.z());
  const double scale = kFocal_px / 4 / depth_w;
  return 0.15 + 0.7 * ValueNoise(point.x() * scale, point.y() * scale, seed);
}

// Returns the light of a wall that fills the picture.
Light Wall(double depth_w) {
  return [depth_w](const Ray& ray, LfImageId, const Vec2&) { return Texture(ray, depth_w, 1); };
}

// Returns the light of a card in front of a wall. The card is in the middle and half as wide as the
// picture.
Light CardBefore(double card_w, double wall_w) {
  return [=](const Ray& ray, LfImageId, const Vec2&) {
    const Vec3 point = ray.At((card_w - ray.origin.z()) / ray.direction.z());
    const double half = card_w * kWidth / kFocal_px / 4;
    const bool hits = std::abs(point.x()) < half && std::abs(point.y()) < half;
    return hits ? Texture(ray, card_w, 2) : Texture(ray, wall_w, 3);
  };
}

// Draws the same texture into the lower right corner of every image.
Light Watermarked(Light light) {
  return [light = std::move(light)](const Ray& ray, LfImageId id, const Vec2& at) {
    if (at.x() > 150 && at.y() > 100) return ValueNoise(at.x() / 4, at.y() / 4, 9);
    return light(ray, id, at);
  };
}

Light Barred(Light light) {
  return [light = std::move(light)](const Ray& ray, LfImageId id, const Vec2& at) {
    return at.y() < 25 || at.y() > kHeight - 25 ? 0 : light(ray, id, at);
  };
}

Light WithDeadPixels(Light light) {
  return [light = std::move(light)](const Ray& ray, LfImageId id, const Vec2& at) {
    const auto x = static_cast<uint64_t>(at.x()), y = static_cast<uint64_t>(at.y());
    return RandomBits(5, x, y) % 300 == 0 ? 1 : light(ray, id, at);
  };
}

Light MaskedAround(Light light) {
  return [light = std::move(light)](const Ray& ray, LfImageId id, const Vec2& at) {
    const double r = (at - Vec2(kWidth, kHeight) / 2).norm();
    return r > 75 ? std::numeric_limits<double>::quiet_NaN() : light(ray, id, at);
  };
}

Light Noisy(Light light, double deviation) {
  return [light = std::move(light), deviation](const Ray& ray, LfImageId id, const Vec2& at) {
    const auto pixel = static_cast<uint64_t>(at.y()) * kWidth + static_cast<uint64_t>(at.x());
    // Uniform noise of width sqrt(12) has a standard deviation of 1.
    return light(ray, id, at) + deviation * std::sqrt(12.) * (RandomUnit(7, id.value, pixel) - 0.5);
  };
}

LightField FieldOf(const std::vector<RigidTransform>& poses) {
  LightField field;
  field.intrinsics = {{kFocal_px, kFocal_px, kWidth / 2., kHeight / 2., 0, kWidth, kHeight}};
  for (const RigidTransform& pose : poses) {
    field.cameras.push_back({pose, 0, 1});
    field.image_names.push_back("drawn.png");
  }
  return field;
}

// Returns a grid of cameras that look along z, or at a point on the z axis if `look_at_w` is not 0.
LightField Grid(int columns, int rows, double spacing_w, double look_at_w = 0) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < columns * rows; ++i) {
    const Vec3 at(spacing_w * (i % columns - columns / 2), spacing_w * (i / columns - rows / 2), 0);
    const Vec3 along = look_at_w > 0 ? Vec3(Vec3(0, 0, look_at_w) - at) : Vec3(0, 0, 1);
    poses.push_back(*LookAlong(at, along.normalized(), {0, -1, 0}));
  }
  return FieldOf(poses);
}

// Swaps cameras, so that LF images have the calibration of other LF images.
LightField Shuffled(LightField field) {
  for (size_t i = 0; i < field.size(); ++i)
    std::swap(field.cameras[i], field.cameras[RandomBits(3, i, 0) % field.size()]);
  return field;
}

LfImageId MiddleOf(const LightField& field) { return {static_cast<uint32_t>(field.size() / 2)}; }

struct Case {
  std::string name;
  LightField field;
  Light light;
  double depth_w = 0;        // 0: no depth can be found
  LightField drawn_by = {};  // the true calibration, if `field` has a wrong one
};

std::vector<Case> Cases() {
  return {
      {"wall, dense", Grid(17, 17, 0.005), Wall(1), 1},
      {"wall, near", Grid(9, 9, 0.02), Wall(0.7), 0.7},
      {"wall, sparse", Grid(5, 5, 0.05), Wall(1.2), 1.2},
      {"wall, far", Grid(17, 17, 0.02), Wall(8), 8},
      {"wall, very dense", Grid(41, 41, 0.001), Wall(0.8), 0.8},
      {"wall from a track", Grid(41, 1, 0.01), Wall(1.5), 1.5},
      {"card before a wall", Grid(9, 9, 0.02), CardBefore(1, 2.5), 1},
      {"card before a wall, converging", Grid(9, 9, 0.03, 2), CardBefore(1.2, 3), 1.2},
      {"wall, converging elsewhere", Grid(9, 9, 0.03, 1), Wall(1.6), 1.6},
      {"watermark before a wall", Grid(9, 9, 0.02), Watermarked(Wall(1.3)), 1.3},
      {"watermark, converging", Grid(9, 9, 0.03, 1), Watermarked(Wall(1.6)), 1.6},
      {"black bars", Grid(9, 9, 0.02), Barred(Wall(1.1)), 1.1},
      {"dead pixels", Grid(9, 9, 0.02), WithDeadPixels(Wall(1.4)), 1.4},
      {"masked around the middle", Grid(9, 9, 0.02), MaskedAround(Wall(0.9)), 0.9},
      {"noise", Grid(9, 9, 0.02), Noisy(Wall(1.25), 0.03), 1.25},
      {"hopeless: grey", Grid(9, 9, 0.02), [](auto&&...) { return 0.5; }},
      {"hopeless: noise alone", Grid(9, 9, 0.02), Noisy([](auto&&...) { return 0.5; }, 0.2)},
      {"hopeless: a lattice", Grid(9, 9, 0.02),
       [](const Ray& ray, LfImageId, const Vec2&) {
         const Vec3 point = ray.At((1 - ray.origin.z()) / ray.direction.z());
         return 0.5 + 0.2 * (std::sin(160 * point.x()) + std::sin(160 * point.y()));
       }},
      {"hopeless: a watermark alone", Grid(9, 9, 0.02), Watermarked([](auto&&...) { return 0.5; })},
      {"hopeless: calibrated as others", Shuffled(Grid(9, 9, 0.04, 1)), Wall(1.2), 0,
       Grid(9, 9, 0.04, 1)},
  };
}

TEST(FindSubject, IsRightOrNotSureOnTwentyCaptures) {
  ThreadPool pool(2);
  for (const Case& one : Cases()) {
    const LightField& drawn_by = one.drawn_by.size() > 0 ? one.drawn_by : one.field;
    const DrawnStore store(drawn_by, one.light);
    const Result<Subject> subject = FindSubject(one.field, store, MiddleOf(one.field), pool);
    ASSERT_TRUE(subject) << one.name << ": " << subject.error().message;
    SCOPED_TRACE(one.name + ", " + std::to_string(subject->place_count) + " of " +
                 std::to_string(subject->textured_count));
    EXPECT_EQ(subject->is_sure, one.depth_w > 0);
    if (one.depth_w == 0 || subject->depths.empty()) continue;
    EXPECT_NEAR(subject->depths[0].distance_w, one.depth_w, 0.02 * one.depth_w);
  }
}

TEST(FindSubject, OffersTheWallBehindTheCard) {
  ThreadPool pool(2);
  const LightField field = Grid(9, 9, 0.02);
  const Subject subject =
      FindSubject(field, DrawnStore(field, CardBefore(1, 2.5)), MiddleOf(field), pool).value();
  ASSERT_GE(subject.depths.size(), 2u);
  EXPECT_NEAR(subject.depths[1].distance_w, 2.5, 0.05);
  EXPECT_GT(subject.depths[0].share, subject.depths[1].share);
  EXPECT_NEAR(subject.near_w, 1, 0.02);
  EXPECT_NEAR(subject.far_w, 2.5, 0.1);
}

TEST(FindSubject, LeavesOutImagesThatCannotBeLoaded) {
  ThreadPool pool(2);
  const LightField field = Grid(9, 9, 0.02);
  DrawnStore store(field, Wall(1));
  const LfImageId middle = MiddleOf(field);
  store.broken = {middle.value + 1};
  EXPECT_TRUE(FindSubject(field, store, middle, pool)->is_sure);
  store.broken = middle;
  EXPECT_FALSE(FindSubject(field, store, middle, pool));
}

TEST(FindSubject, LeavesOutNoImageThatTheMachineCannotLoad) {
  ThreadPool pool(2);
  const LightField field = Grid(9, 9, 0.02);
  DrawnStore store(field, Wall(1));
  store.broken = {MiddleOf(field).value + 1};
  store.failure = OutputError("drawn.png: no memory to load it");
  const Result<Subject> subject = FindSubject(field, store, MiddleOf(field), pool);
  ASSERT_FALSE(subject);
  EXPECT_EQ(subject.error().kind, ErrorKind::kOutput);
}

TEST(FindSubject, TwoCamerasAreTooFew) {
  ThreadPool pool(2);
  const LightField field = Grid(2, 1, 0.02);
  const Result<Subject> subject = FindSubject(field, DrawnStore(field, Wall(1)), {0}, pool);
  ASSERT_TRUE(subject);
  EXPECT_FALSE(subject->is_sure);
  EXPECT_TRUE(subject->depths.empty());
}

}  // namespace
}  // namespace lf
