#include "lf/camera/pinhole.h"

#include <gtest/gtest.h>

#include "lf/core/random.h"

namespace lf {
namespace {

PinholeCamera SkewedCamera() {
  PinholeCamera camera;
  camera.intrinsics = {500, 480, 321.5, 238.25, 3, 640, 480};
  camera.cam_from_world = *LookAlong({1, -2, 0.5}, {0.3, 0.1, 1}, {0, -1, 0.2});
  return camera;
}

TEST(Pinhole, ProjectionUndoesTheRay) {
  const PinholeCamera camera = SkewedCamera();
  for (uint64_t i = 0; i < 1000; ++i) {
    const Vec2 pixel(640 * RandomUnit(1, 0, i), 480 * RandomUnit(1, 1, i));
    const Ray ray = RayOfPixel(camera, pixel.x(), pixel.y());
    const Vec2 back = *Project(camera, ray.At(0.1 + 10 * RandomUnit(1, 2, i)));
    EXPECT_NEAR((back - pixel).norm(), 0, 1e-9);
  }
}

TEST(Pinhole, TheDirectionOfARayIsOneDeep) {
  const PinholeCamera camera = SkewedCamera();
  const Ray ray = RayOfPixel(camera, 12, 400);
  EXPECT_NEAR(camera.ForwardWorld().dot(ray.direction), 1, 1e-12);
}

TEST(Pinhole, PointsBehindAreNotSeen) {
  const PinholeCamera camera = SkewedCamera();
  EXPECT_FALSE(Project(camera, camera.CentreWorld() - camera.ForwardWorld()));
  EXPECT_FALSE(Project(camera, camera.CentreWorld()));
}

TEST(Pinhole, InverseMatrixInverts) {
  const Intrinsics k = SkewedCamera().intrinsics;
  EXPECT_NEAR((k.Matrix() * k.InverseMatrix() - Mat3::Identity()).norm(), 0, 1e-12);
}

TEST(Pinhole, LookAlongPutsUpAboveAndRightToTheRight) {
  const RigidTransform t = *LookAlong({0, 0, 0}, {0, 0, 1}, {0, -1, 0});
  EXPECT_NEAR((t.rotation - Mat3::Identity()).norm(), 0, 1e-15);
  const PinholeCamera camera = SkewedCamera();
  EXPECT_NEAR(camera.cam_from_world.rotation.determinant(), 1, 1e-12);
  EXPECT_GT(camera.UpWorld().dot(Vec3(0, -1, 0.2)), 0);
  EXPECT_FALSE(LookAlong({0, 0, 0}, {0, 1, 0}, {0, -1, 0}));
  EXPECT_FALSE(LookAlong({0, 0, 0}, {0, 0, 0}, {0, -1, 0}));
}

}  // namespace
}  // namespace lf
