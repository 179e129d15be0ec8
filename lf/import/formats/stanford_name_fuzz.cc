// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a file name: either the name does not have the Stanford form, or its values
// must be finite and within their limits.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/formats/stanford_name.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view file_name(reinterpret_cast<const char*>(bytes), size_bytes);
  LF_CHECK(lf::NumberOfHciName(file_name).value_or(0) >= 0);
  const auto name = lf::ParseStanfordName(file_name);
  if (!name) return 0;
  LF_CHECK(name->row >= 0 && name->column >= 0);
  if (name->position)
    LF_CHECK(std::isfinite(name->position->y_mm) && std::isfinite(name->position->x_mm));
  LF_CHECK(!name->lens || name->position);
  if (name->lens)
    LF_CHECK(name->lens->focal_mm > 0 && std::isfinite(name->lens->focal_mm) &&
             name->lens->sensor_width_mm > 0 && std::isfinite(name->lens->sensor_width_mm));
  return 0;
}
