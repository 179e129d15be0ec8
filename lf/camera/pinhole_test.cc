// SPDX-License-Identifier: Apache-2.0
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

// Returns P = K [R|t] of SkewedCamera(), with the entries of K written out (thesis Eq. 2.5, 2.6).
Eigen::Matrix<double, 3, 4> CameraMatrix(const PinholeCamera& camera) {
  Mat3 k;
  k << 500, 3, 321.5,  // fx, s, cx
      0, 480, 238.25,  // fy, cy
      0, 0, 1;
  Eigen::Matrix<double, 3, 4> extrinsic;
  extrinsic << camera.cam_from_world.rotation, camera.cam_from_world.translation;
  return k * extrinsic;
}

TEST(Pinhole, ProjectsByTheCameraMatrix) {
  const PinholeCamera camera = SkewedCamera();
  const Eigen::Matrix<double, 3, 4> p = CameraMatrix(camera);
  for (uint64_t i = 0; i < 1000; ++i) {
    const Vec3 point = camera.CentreWorld() + camera.ForwardWorld() +
                       Vec3(RandomUnit(2, 0, i), RandomUnit(2, 1, i), RandomUnit(2, 2, i)) / 2;
    const Vec3 image = p * point.homogeneous();  // thesis Eq. 2.7: (x', y', w)
    const Vec2 expected(image.x() / image.z(), image.y() / image.z());
    EXPECT_NEAR((*Project(camera, point) - expected).norm(), 0, 1e-9);
  }
  // A camera at the origin sees (x, y, z) at (fx x/z + s y/z + cx, fy y/z + cy).
  PinholeCamera at_origin;
  at_origin.intrinsics = camera.intrinsics;
  EXPECT_NEAR((*Project(at_origin, {1, -2, 4}) - Vec2(445, -1.75)).norm(), 0, 1e-12);
}

// Compares RayOfPixel() with p_camera = K^-1 p and the inverse of the 4 x 4 matrix of thesis Eq.
// 4.2, both computed by a general matrix inverse.
TEST(Pinhole, RaysGoThroughThePointsOfTheInverseMatrices) {
  const PinholeCamera camera = SkewedCamera();
  Eigen::Matrix4d extrinsic = Eigen::Matrix4d::Identity();
  extrinsic.topLeftCorner<3, 3>() = camera.cam_from_world.rotation;
  extrinsic.topRightCorner<3, 1>() = camera.cam_from_world.translation;
  Mat3 k;
  k << 500, 3, 321.5, 0, 480, 238.25, 0, 0, 1;
  for (uint64_t i = 0; i < 200; ++i) {
    const Vec2 pixel(640 * RandomUnit(4, 0, i), 480 * RandomUnit(4, 1, i));
    const Vec3 p_camera = k.inverse() * Vec3(pixel.x(), pixel.y(), 1);
    const Vec3 p_world = (extrinsic.inverse() * p_camera.homogeneous()).head<3>();
    const Vec3 centre = extrinsic.inverse().topRightCorner<3, 1>();
    const Ray ray = RayOfPixel(camera, pixel.x(), pixel.y());
    EXPECT_NEAR((ray.origin - centre).norm(), 0, 1e-12);
    EXPECT_NEAR((ray.At(1) - p_world).norm(), 0, 1e-12);
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
  Mat3 expected;  // thesis Eq. 2.5
  expected << 500, 3, 321.5, 0, 480, 238.25, 0, 0, 1;
  EXPECT_EQ(k.Matrix(), expected);
  EXPECT_NEAR((expected * k.InverseMatrix() - Mat3::Identity()).norm(), 0, 1e-12);
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
