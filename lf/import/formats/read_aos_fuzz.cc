// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a poses.json of Airborne Optical Sectioning: the result must be valid poses
// or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/formats/read_aos.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::LightField> light_field = lf::ParseAosPoses(text, "f/poses.json");
  if (!light_field) {
    LF_CHECK(light_field.error().message.starts_with("f/poses.json: "));
    return 0;
  }
  LF_CHECK(light_field->size() > 0);
  LF_CHECK(light_field->image_names.size() == light_field->size());
  for (const lf::LfCamera& camera : light_field->cameras) {
    const lf::Mat3& rotation = camera.cam_from_world.rotation;
    const lf::Mat3 error = rotation * rotation.transpose() - lf::Mat3::Identity();
    LF_CHECK(error.cwiseAbs().maxCoeff() < 1e-11);
    LF_CHECK(rotation.determinant() > 0);
    LF_CHECK(camera.cam_from_world.translation.allFinite());
  }
  return 0;
}
