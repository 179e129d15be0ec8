// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/lf_light.h"

#include "lf/core/check.h"
#include "lf/core/geometry.h"

namespace lf {

Image<float> LightOf(const LfPixels& pixels, const RadianceEncoding& encoding, float masked) {
  LF_CHECK(pixels.bayer == BayerPattern::kNone);
  const Eigen::DiagonalMatrix<double, 3> balance(
      encoding.white_balance[0], encoding.white_balance[1], encoding.white_balance[2]);
  const Mat3 matrix = encoding.linear_srgb_from_camera * balance / encoding.Scale();
  const Vec3 offset = -encoding.pedestal * (matrix * Vec3::Ones());
  Image<float> light(pixels.radiance.width(), pixels.radiance.height(), 3);
  for (int y = 0; y < light.height(); ++y) {
    const uint16_t* from = pixels.radiance.row(y);
    float* to = light.row(y);
    for (int x = 0; x < light.width(); ++x, from += LfPixels::kRgbLanes, to += 3) {
      const Vec3 value = matrix * Vec3(from[0], from[1], from[2]) + offset;
      for (int channel = 0; channel < 3; ++channel)
        to[channel] = from[LfPixels::kRayLane] == 0 ? masked : static_cast<float>(value[channel]);
    }
  }
  return light;
}

}  // namespace lf
