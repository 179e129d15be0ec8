// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a poses_bounds.npy of LLFF: the result must be a light field with valid
// cameras or an error.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/check.h"
#include "lf/import/formats/read_llff.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto size = [](const auto&) -> lf::Result<std::array<int, 2>> {
    return std::array{640, 480};
  };
  for (const size_t count : {1, 2, 3}) {
    const std::vector<std::string> names(count, "a.png");
    const auto light_field = lf::ParseLlff(text, "f/poses_bounds.npy", names, size);
    if (!light_field) {
      LF_CHECK(light_field.error().message.starts_with("f/poses_bounds.npy: "));
      continue;
    }
    LF_CHECK(light_field->size() == count && light_field->image_names.size() == count);
    LF_CHECK(light_field->depth_range->near_w > 0 &&
             light_field->depth_range->near_w < light_field->depth_range->far_w);
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
  }
  return 0;
}
