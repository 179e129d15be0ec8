// SPDX-License-Identifier: Apache-2.0
// Identifies a light field by hashes, so that packages and resumed renders can check that a light
// field is still the same.
#pragma once

#include <cstddef>
#include <string>

#include "lf/light_field/model/light_field.h"

namespace lf {

struct LightFieldIdentity {
  size_t image_count = 0;
  std::string names;  // hash of the names of images and masks, without the folder
  // Hash of the poses, gains and intrinsics of all cameras, of which of them are virtual, and of
  // the recording times if several slices are open.
  std::string calibration;

  friend bool operator==(const LightFieldIdentity&, const LightFieldIdentity&) = default;
};

LightFieldIdentity IdentityOf(const LightField& light_field);

}  // namespace lf
