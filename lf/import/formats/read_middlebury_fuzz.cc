// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a Middlebury NAME_par.txt: the result must be a light field with valid
// cameras or an error.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/formats/read_middlebury.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto size = [](const auto&) -> lf::Result<std::array<int, 2>> {
    return std::array{640, 480};
  };
  const lf::Result<lf::LightField> light_field = lf::ParseMiddlebury(text, "f/a_par.txt", size);
  if (!light_field) {
    LF_CHECK(light_field.error().message.starts_with("f/a_par.txt: "));
    return 0;
  }
  LF_CHECK(light_field->size() > 0);
  LF_CHECK(light_field->image_names.size() == light_field->size());
  for (uint32_t i = 0; i < light_field->size(); ++i) {
    LF_CHECK(light_field->cameras[i].intrinsics_index < light_field->intrinsics.size());
    const lf::PinholeCamera camera = light_field->Camera({i});
    const lf::Mat3& rotation = camera.cam_from_world.rotation;
    const lf::Mat3 error = rotation * rotation.transpose() - lf::Mat3::Identity();
    LF_CHECK(error.cwiseAbs().maxCoeff() < 1e-11);
    LF_CHECK(rotation.determinant() > 0);
    LF_CHECK(camera.cam_from_world.translation.allFinite());
    LF_CHECK(camera.intrinsics.InverseMatrix().allFinite());
  }
  return 0;
}
