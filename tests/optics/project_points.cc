// SPDX-License-Identifier: Apache-2.0
// Projects directions through a camera, for camera_models_test.py.
//
// stdin   fx fy cx cy  MODEL  p1 .. p12, then X Y Z of each direction
// stdout  for each direction, x y of its pixel and X Y Z of the ray of this pixel; or "none"
// MODEL   none, radial-tangential, fisheye, fov, division, unified, thin-prism,
//         radial-tangential-thin-prism or brown
#include <cstdio>
#include <iostream>
#include <string>

#include "lf/camera/ideal_pixels.h"

namespace {

int Fail(const char* message) {
  std::fprintf(stderr, "project_points: %s\n", message);
  return 3;
}

}  // namespace

int main() {
  lf::Intrinsics k;
  std::string model;
  std::cin >> k.fx_px >> k.fy_px >> k.cx_px >> k.cy_px >> model;
  if (model == "radial-tangential")
    k.distortion.model = lf::DistortionModel::kRadialTangential;
  else if (model == "fisheye")
    k.distortion.model = lf::DistortionModel::kFisheye;
  else if (model == "fov")
    k.distortion.model = lf::DistortionModel::kFov;
  else if (model == "division")
    k.distortion.model = lf::DistortionModel::kDivision;
  else if (model == "unified")
    k.distortion.model = lf::DistortionModel::kUnified;
  else if (model == "thin-prism")
    k.distortion.model = lf::DistortionModel::kThinPrism;
  else if (model == "radial-tangential-thin-prism")
    k.distortion.model = lf::DistortionModel::kRadialTangentialThinPrism;
  else if (model == "brown")
    k.distortion.model = lf::DistortionModel::kBrown;
  else if (model != "none")
    return Fail("unknown model");
  for (double& parameter : k.distortion.parameters) std::cin >> parameter;
  if (!std::cin) return Fail("expected fx fy cx cy MODEL p1 .. p12");
  const lf::DistortionMap map(k.distortion);
  for (double x, y, z; std::cin >> x >> y >> z;) {
    const auto distorted = map.Distort({x, y, z});
    if (!distorted) {
      std::puts("none");
      continue;
    }
    const lf::Vec3 p = k.Matrix() * lf::Vec3(distorted->x(), distorted->y(), 1);
    const auto ideal = lf::IdealPosition(k, map, p.x(), p.y());
    if (!ideal) return Fail("a pixel has no ray back");
    const lf::Vec3 direction = k.InverseMatrix() * *ideal;
    std::printf("%.17g %.17g %.17g %.17g %.17g\n", p.x(), p.y(), direction.x(), direction.y(),
                direction.z());
  }
  return 0;
}
