// Finds poses that were photographed several times with different exposures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/capture/light_field.h"

namespace lf {

struct FoundBrackets {
  size_t pose_count = 0;                           // poses with several exposures
  size_t image_count = 0;                          // LF images of these poses
  size_t least_exposures = 0, most_exposures = 0;  // different ones of a pose
  // Exposures of the pose that has most of them, ascending, in stops (factors of two) beside the
  // middle one; of an even number, beside the darker of the two in the middle.
  std::vector<double> stops;
  bool are_gains = false;       // lf_gain tells the exposures; else the files do
  std::vector<bool> of_images;  // of these poses
};

// Exposures of one pose that differ by less than kOneExposure (capture/brackets.h) are one.
//   firsts  FirstOfPose(light_field)
//   lights  LightOf() the files (exif_gains.h), which counts where lf_gain tells no difference;
//           NaN: not known; empty: of none
// None where no pose has several exposures.
std::optional<FoundBrackets> FindBrackets(const LightField& light_field,
                                          std::span<const uint32_t> firsts,
                                          std::span<const double> lights);

}  // namespace lf
