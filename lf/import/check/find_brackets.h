// SPDX-License-Identifier: Apache-2.0
// Finds poses that were photographed several times with different exposures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/light_field/model/light_field.h"

namespace lf {

struct FoundBrackets {
  size_t pose_count = 0;   // number of poses with several exposures
  size_t image_count = 0;  // number of LF images of these poses
  // Least and largest number of different exposures that one of these poses has.
  size_t least_exposures = 0, most_exposures = 0;
  // Exposures of the pose with most exposures, ascending, in stops (factors of two) relative to the
  // middle exposure (if their number is even, to the smaller of the two in the middle).
  std::vector<double> stops;
  bool are_gains = false;       // true: the exposures come from lf_gain in the calibration
  std::vector<bool> of_images;  // [LF images]: true for LF images of poses with several exposures
};

// Finds the poses with several exposures; nullopt if there are none. Exposures of one pose that
// differ by less than kOneExposure (light_field/model/brackets.h) count as one.
//   firsts  FirstOfPose(light_field) (light_field/model/brackets.h)
//   lights  LightOf() (exif_gains.h) of each LF image's file, used if the gains of the calibration
//           (lf_gain) show no pose with several exposures. NaN: unknown; empty: all are unknown
std::optional<FoundBrackets> FindBrackets(const LightField& light_field,
                                          std::span<const uint32_t> firsts,
                                          std::span<const double> lights);

}  // namespace lf
