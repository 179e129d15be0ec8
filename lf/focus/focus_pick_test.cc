// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/focus_pick.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"

namespace lf {
namespace {

constexpr int kSide = 9;
constexpr double kSpacing_w = 0.02, kNear_w = 1.2, kFar_w = 2;

// Returns a sum of waves without a period, in [0.2, 0.8].
double Waves(double x, double y) {
  return 0.5 + 0.1 * (std::sin(31 * x + 17 * y) + std::sin(53 * y - 29 * x * x) +
                      std::sin(71 * x + 5 * y * y));
}

// Returns the light along a ray to a near wall, which covers only x < 0, or to the far wall behind
// it. The right end of the far wall (x > 0.6) is white.
double LightOfWalls(const Ray& ray) {
  const Vec3 near = ray.At((kNear_w - ray.origin.z()) / ray.direction.z());
  if (near.x() < 0) return Waves(near.x(), near.y());
  const Vec3 far = ray.At((kFar_w - ray.origin.z()) / ray.direction.z());
  return far.x() > 0.6 ? 0.9 : Waves(far.x() + 3, far.y());
}

// Draws the walls into the requested rectangle. The images have different gains.
class WallStore : public LfImageStore {
 public:
  explicit WallStore(const LightField& field) : field_(field) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (is_broken || id == broken_id) return InputError("wall.png: not found");
    const PinholeCamera camera = field_.Camera(id);
    const double gain = 1 - 0.02 * (id.value % 5);
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        const auto ray = RayOfLfPixel(camera, rect.x_begin + x + 0.5, rect.y_begin + y + 0.5);
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) =
              static_cast<uint16_t>(ray ? 65535 * gain * LightOfWalls(*ray) : 0);
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
      }
    return {};
  }

  bool is_broken = false;
  std::optional<LfImageId> broken_id;

 private:
  const LightField& field_;
};

LightField FieldBeforeWalls(const Distortion& distortion = {}) {
  LightField field;
  field.intrinsics = {{300, 300, 160, 120, 0, 320, 240, distortion}};
  for (int i = 0; i < kSide * kSide; ++i) {
    LfCamera camera;
    const double x = kSpacing_w * (i % kSide - kSide / 2), y = kSpacing_w * (i / kSide - kSide / 2);
    camera.cam_from_world = *LookAlong({x, y, 0}, {0, 0, 1}, {0, -1, 0});
    field.cameras.push_back(camera);
    field.image_names.push_back("wall.png");
  }
  return field;
}

// Returns a frame whose lens is between the LF cameras and 0.12 wide.
RenderCamera Frame() {
  RenderCamera frame;
  frame.pinhole.intrinsics = {300, 300, 160, 120, 0, 320, 240};
  frame.pinhole.cam_from_world = *LookAlong({0.009, 0.004, 0}, {0, 0, 1}, {0, -1, 0});
  frame.aperture.radius_w = 0.06;
  frame.focus_tilt = {0.1, 0.2};
  return frame;
}

// A wall with a pattern that repeats every 0.05 world units.
class LatticeStore : public LfImageStore {
 public:
  explicit LatticeStore(const LightField& field) : field_(field) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    pixels->Reset(rect, BayerPattern::kNone);
    for (int y = 0; y < rect.height(); ++y)
      for (int x = 0; x < rect.width(); ++x) {
        const auto ray =
            *RayOfLfPixel(field_.Camera(id), rect.x_begin + x + 0.5, rect.y_begin + y + 0.5);
        const Vec3 point = ray.At((kFar_w - ray.origin.z()) / ray.direction.z());
        constexpr double kWave = 2 * kPi / 0.05;
        const double light =
            0.5 + 0.2 * (std::sin(kWave * point.x()) + std::sin(kWave * point.y()));
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x, y, c) = static_cast<uint16_t>(65535 * light);
        pixels->radiance.at(x, y, LfPixels::kRayLane) = 1;
      }
    return {};
  }

 private:
  const LightField& field_;
};

Result<FocusPick> PickInFrame(const LightField& field, double x_px, double y_px) {
  ThreadPool pool(2);
  return FindFocus(field, WallStore(field), Frame(), RayOfPixel(Frame().pinhole, x_px, y_px), pool);
}

TEST(FocusPick, FindsBothWalls) {
  const LightField field = FieldBeforeWalls();
  for (const double y : {60.0, 130.0, 190.0}) {
    const auto far = PickInFrame(field, 200, y);
    ASSERT_TRUE(far) << far.error().message;
    EXPECT_NEAR(far->point_world.z(), kFar_w, 0.01 * kFar_w);
    EXPECT_GT(far->certainty, 0.4);
    EXPECT_GE(far->images.size(), 8u);
    const auto near = PickInFrame(field, 80, y);
    ASSERT_TRUE(near) << near.error().message;
    EXPECT_NEAR(near->point_world.z(), kNear_w, 0.01 * kNear_w);
  }
}

// Close to the edge of the near wall, half of the LF cameras see the near wall instead of the
// point.
TEST(FocusPick, AgreesWithThoseThatSeeThePoint) {
  const auto far = PickInFrame(FieldBeforeWalls(), 176, 120);
  ASSERT_TRUE(far) << far.error().message;
  EXPECT_NEAR(far->point_world.z(), kFar_w, 0.03 * kFar_w);
}

TEST(FocusPick, StartsFromPixelsOfLfImages) {
  for (const Distortion& distortion :
       {Distortion(), Distortion{DistortionModel::kRadialTangential, {-0.12, 0.03}}}) {
    const LightField field = FieldBeforeWalls(distortion);
    ThreadPool pool(1);
    const LfImageId id{33};
    const auto ray = RayOfLfPixel(field.Camera(id), 60, 70);
    ASSERT_TRUE(ray);
    const auto pick = FindFocus(field, WallStore(field), Frame(), *ray, pool);
    ASSERT_TRUE(pick) << pick.error().message;
    EXPECT_EQ(pick->images[0], id);
    EXPECT_NEAR(pick->point_world.z(), kNear_w, 0.01 * kNear_w);
  }
}

TEST(FocusPick, TheNearestImageThatCanBeReadComesFirst) {
  const LightField field = FieldBeforeWalls();
  ThreadPool pool(2);
  const Ray ray = RayOfPixel(Frame().pinhole, 200, 120);
  const auto distance = [&](LfImageId id) {
    return (field.Camera(id).CentreWorld() - ray.origin).norm();
  };
  WallStore store(field);
  const auto whole = FindFocus(field, store, Frame(), ray, pool);
  ASSERT_TRUE(whole) << whole.error().message;
  store.broken_id = whole->images[0];
  const auto pick = FindFocus(field, store, Frame(), ray, pool);
  ASSERT_TRUE(pick) << pick.error().message;
  EXPECT_EQ(pick->images.size(), whole->images.size() - 1);
  for (const LfImageId id : pick->images) EXPECT_LE(distance(pick->images[0]), distance(id));
  EXPECT_NEAR(pick->point_world.z(), kFar_w, 0.01 * kFar_w);
}

TEST(FocusPick, SaysWhyThereIsNone) {
  const auto white = PickInFrame(FieldBeforeWalls(), 290, 120);
  ASSERT_FALSE(white);
  EXPECT_NE(white.error().message.find("texture"), std::string::npos) << white.error().message;

  LightField few = FieldBeforeWalls();
  few.cameras.resize(3);
  EXPECT_FALSE(PickInFrame(few, 200, 120));

  const LightField field = FieldBeforeWalls();
  WallStore store(field);
  store.is_broken = true;
  ThreadPool pool(1);
  const auto broken = FindFocus(field, store, Frame(), RayOfPixel(Frame().pinhole, 200, 120), pool);
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find("wall.png"), std::string::npos);
}

TEST(FocusPick, TiltedPlanesHoldThePoint) {
  RenderCamera frame = Frame();
  const Vec3 point(0.3, -0.2, 1.7);
  const double distance_w = FocusDistanceThrough(frame, point);
  const Plane plane = FocusPlane(frame.pinhole, distance_w, frame.focus_tilt);
  EXPECT_NEAR(plane.normal.dot(point), plane.offset_w, 1e-12);
}

TEST(FocusPick, APatternThatRepeatsIsNotCertain) {
  ThreadPool pool(2);
  const LightField field = FieldBeforeWalls();
  const auto pick =
      FindFocus(field, LatticeStore(field), Frame(), RayOfPixel(Frame().pinhole, 160, 120), pool);
  if (!pick) return;
  EXPECT_LT(pick->certainty, kLeastCertainty);
}

}  // namespace
}  // namespace lf
