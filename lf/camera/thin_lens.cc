// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/thin_lens.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace lf {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Result<double> ImageDistance(double focal_length_w, double focus_distance_w) {
  if (!(focal_length_w > 0))
    return InputError(fmt::format("the focal length is {}, expected more than 0", focal_length_w));
  if (!(focus_distance_w > focal_length_w))
    return InputError(fmt::format(
        "the focus distance is {}, expected more than the focal length {}, because a lens forms no "
        "real image of nearer points",
        focus_distance_w, focal_length_w));
  if (std::isinf(focus_distance_w)) return focal_length_w;
  return focal_length_w * focus_distance_w / (focus_distance_w - focal_length_w);
}

double FNumber(double focal_length_w, double aperture_diameter_w) {
  return aperture_diameter_w > 0 ? focal_length_w / aperture_diameter_w : kInfinity;
}

double BlurOnFocusPlane(double aperture_diameter_w, double focus_distance_w, double depth_w) {
  return aperture_diameter_w * std::abs(depth_w - focus_distance_w) / depth_w;
}

DepthRange DepthOfField(double aperture_diameter_w, double focus_distance_w, double blur_limit_w) {
  // For depth z and focus distance g, the condition d |z - g| / z <= c is equivalent to
  //   d g / (d + c) <= z <= d g / (d - c)    (no upper limit if d <= c)
  const double d = aperture_diameter_w;
  const double c = blur_limit_w;
  if (!(d > 0)) return {0, kInfinity};
  return {d * focus_distance_w / (d + c), d > c ? d * focus_distance_w / (d - c) : kInfinity};
}

}  // namespace lf
