// SPDX-License-Identifier: Apache-2.0
// Parses any bytes: the result must be an error, or a light field that passes the checks below.
// FrameCutter must find the same frames whether it is given the text byte by byte or at once.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "lf/core/check.h"
#include "lf/light_field/transforms_json/frame_cutter.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace {

// Returns the frames, one per line, followed by the rest.
std::string Cut(std::string_view text, size_t piece_size) {
  std::string frames;
  lf::FrameCutter cutter("frames", [&](const std::string& frame) { frames += frame + '\n'; });
  for (size_t i = 0; i < text.size(); i += piece_size) cutter.Add(text.substr(i, piece_size));
  return frames + cutter.rest();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::LightField> light_field = lf::ParseTransformsJson(text, "f/transforms.json");
  LF_CHECK(Cut(text, 1) == Cut(text, std::string_view::npos / 2));
  if (!light_field) {
    LF_CHECK(light_field.error().message.starts_with("f/transforms.json: "));
    return 0;
  }
  LF_CHECK(light_field->size() > 0);
  LF_CHECK(light_field->image_names.size() == light_field->size());
  LF_CHECK(light_field->mask_names.empty() ||
           light_field->mask_names.size() == light_field->size());
  LF_CHECK(lf::LevelsFit(light_field->encoding, 16));
  LF_CHECK(light_field->encoding.Scale() > 0);
  for (uint32_t i = 0; i < light_field->size(); ++i) {
    LF_CHECK(light_field->cameras[i].intrinsics_index < light_field->intrinsics.size());
    const lf::PinholeCamera camera = light_field->Camera({i});
    const lf::Mat3& rotation = camera.cam_from_world.rotation;
    const lf::Mat3 error = rotation * rotation.transpose() - lf::Mat3::Identity();
    LF_CHECK(error.cwiseAbs().maxCoeff() < 1e-11);
    LF_CHECK(camera.cam_from_world.translation.allFinite());
    LF_CHECK(camera.intrinsics.InverseMatrix().allFinite());
    LF_CHECK(camera.intrinsics.width_px > 0 && camera.intrinsics.height_px > 0);
    for (const float gain : light_field->cameras[i].gain.of_channels)
      LF_CHECK(gain > 0 && std::isfinite(gain));
  }
  if (light_field->depth_range)
    LF_CHECK(light_field->depth_range->near_w > 0 &&
             light_field->depth_range->near_w < light_field->depth_range->far_w);
  constexpr size_t kTried = 4;
  for (size_t i = 0; i < std::min(kTried, light_field->intrinsics.size()); ++i) {
    const lf::DistortionMap map(light_field->intrinsics[i].distortion);
    for (const double x : {0.0, 0.4, 100.0}) {
      const auto direction = map.Undistort({x, -0.3});
      LF_CHECK(!direction || direction->allFinite());
    }
  }
  return 0;
}
