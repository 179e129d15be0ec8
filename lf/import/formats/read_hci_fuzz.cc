// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a parameters.cfg of the 4D Light Field Benchmark: the result must be a light
// field with valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/formats/read_hci.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::LightField> light_field = lf::ParseHci(text, "f/parameters.cfg");
  if (!light_field) {
    LF_CHECK(light_field.error().message.starts_with("f/parameters.cfg: "));
    return 0;
  }
  LF_CHECK(light_field->size() > 0);
  LF_CHECK(light_field->image_names.size() == light_field->size());
  for (const lf::LfCamera& camera : light_field->cameras) {
    LF_CHECK(camera.intrinsics_index < light_field->intrinsics.size());
    LF_CHECK(camera.cam_from_world.translation.allFinite());
  }
  for (const lf::Intrinsics& k : light_field->intrinsics)
    LF_CHECK(k.InverseMatrix().allFinite() && k.width_px > 0 && k.height_px > 0);
  if (light_field->depth_range)
    LF_CHECK(light_field->depth_range->near_w > 0 &&
             light_field->depth_range->near_w < light_field->depth_range->far_w);
  return 0;
}
