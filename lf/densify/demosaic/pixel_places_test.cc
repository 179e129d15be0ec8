// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/pixel_places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lf/densify/test_world.h"

namespace lf {
namespace {

Distortion Barrel() {
  Distortion distortion;
  distortion.model = DistortionModel::kRadialTangential;
  distortion.parameters = {-0.1, 0.02, 0.001, -0.002};
  return distortion;
}

// Returns where a camera with distortion sees a point: the centre of the upper left pixel is (0,
// 0).
Vec2 PlaceOf(const PinholeCamera& camera, const Vec3& point_world) {
  const Intrinsics& k = camera.intrinsics;
  const Vec2 distorted = *DistortionMap(k.distortion).Distort(camera.cam_from_world * point_world);
  return {k.fx_px * distorted.x() + k.cx_px - 0.5, k.fy_px * distorted.y() + k.cy_px - 0.5};
}

TEST(PixelPlaces, APointIsFoundWhereTheOtherCameraSeesIt) {
  PinholeCamera from = CameraAt(0, 0), to = CameraAt(0.2, -0.1);
  for (const bool from_distorts : {false, true})
    for (const bool to_distorts : {false, true}) {
      from.intrinsics.distortion = from_distorts ? Barrel() : Distortion();
      to.intrinsics.distortion = to_distorts ? Barrel() : Distortion();
      const IdealPositions ideal(from);
      const PixelPlaces places(from, to);
      for (const int x : {5, 40, 90})
        for (const int y : {3, 33, 60}) {
          const Vec2 at = ideal.At(x, y);
          const double depth = 2.5;
          const Vec3 point =
              depth * (WorkingCamera(from, 1).intrinsics.InverseMatrix() * Vec3(at.x(), at.y(), 1));
          // The position without distortion belongs to the pixel itself.
          EXPECT_LT((PlaceOf(from, point) - Vec2(x, y)).norm(), 1e-4);
          const PixelPlaces::Place found =
              places.At(static_cast<float>(at.x()), static_cast<float>(at.y()),
                        static_cast<float>(1 / depth));
          EXPECT_LT((PlaceOf(to, point) - Vec2(found.x, found.y)).norm(), 1e-3);
        }
    }
}

TEST(PixelPlaces, OffsetsUndoRollAndScale) {
  const PinholeCamera from = CameraAt(0, 0);
  PinholeCamera to = CameraAt(0.1, 0.2);
  to.intrinsics.fx_px *= 2;
  to.intrinsics.fy_px *= 2;
  const Mat3 roll = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).matrix();
  to.cam_from_world = RigidTransform{roll, Vec3::Zero()} * to.cam_from_world;
  const PixelPlaces places(from, to);
  const PixelPlaces::Offsets offsets = places.OffsetsIn(IdealPositions(from), 96, 64, 0.5F);
  const PixelPlaces::Place at = places.At(40, 30, 0.5F), beside = places.At(41, 29.5F, 0.5F);
  EXPECT_NEAR(offsets.X(beside.x - at.x, beside.y - at.y), 1, 1e-3);
  EXPECT_NEAR(offsets.Y(beside.x - at.x, beside.y - at.y), -0.5, 1e-3);
}

TEST(PixelPlaces, ACameraThatLooksTheOtherWayHasNoPlace) {
  const PinholeCamera from = CameraAt(0, 0);
  PinholeCamera to = from;
  to.cam_from_world.rotation = Vec3(-1, 1, -1).asDiagonal();
  EXPECT_TRUE(std::isnan(PixelPlaces(from, to).At(40, 30, 0.5F).x));
}

}  // namespace
}  // namespace lf
