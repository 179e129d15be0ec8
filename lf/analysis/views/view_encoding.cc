// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_encoding.h"

#include <algorithm>
#include <cmath>

namespace lf {

RadianceEncoding EncodingOfLight(const RadianceEncoding& recorded) {
  constexpr double kMostRadiance = 1e6;  // limit of lf_max_radiance
  const double above = recorded.max_radiance, below = recorded.pedestal / recorded.Scale();
  double brightest = 0, darkest = 0;
  for (int row = 0; row < 3; ++row) {
    double bright = 0, dark = 0;
    for (int c = 0; c < 3; ++c) {
      const double factor =
          recorded.linear_srgb_from_camera(row, c) * recorded.white_balance[static_cast<size_t>(c)];
      bright += factor > 0 ? factor * above : -factor * below;
      dark += factor > 0 ? factor * below : -factor * above;
    }
    brightest = std::max(brightest, bright);
    darkest = std::max(darkest, dark);
  }
  RadianceEncoding light;
  light.transfer = Transfer::kLinear;
  light.max_radiance = std::clamp(brightest, 1e-6, kMostRadiance);
  light.pedestal =
      std::min(kMostPedestal, std::round(65535 * darkest / (darkest + light.max_radiance)));
  return light;
}

}  // namespace lf
