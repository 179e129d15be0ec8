// SPDX-License-Identifier: Apache-2.0
// Finds the colour profiles of LF images, for the report.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "lf/light_field/model/light_field.h"

namespace lf {

// The colour profile of photographs whose values are not those of sRGB.
struct FoundProfile {
  std::string name;           // of the first such image: "Display P3"
  size_t image_count = 0;     // number of examined images with such a profile
  size_t asked_count = 0;     // number of examined images
  bool is_converted = false;  // true: to sRGB; false: the encoding says what the values mean
};

// Reads the headers of up to 15 evenly spread images. nullopt if none has such a profile, and for
// packed stores, whose pixels are already converted.
std::optional<FoundProfile> FindProfile(const LightField& light_field);

// Returns a text for people, such as "Display P3 in 15 of 15 examined images, converted to sRGB".
std::string TextOf(const FoundProfile& profile);

}  // namespace lf
