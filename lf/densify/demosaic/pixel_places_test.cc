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

TEST(PixelPlaces, ACameraThatLooksTheOtherWayHasNoPlace) {
  const PinholeCamera from = CameraAt(0, 0);
  PinholeCamera to = from;
  to.cam_from_world.rotation = Vec3(-1, 1, -1).asDiagonal();
  EXPECT_TRUE(std::isnan(PixelPlaces(from, to).At(40, 30, 0.5F).x));
}

}  // namespace
}  // namespace lf
