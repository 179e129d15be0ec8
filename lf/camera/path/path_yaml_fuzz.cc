// SPDX-License-Identifier: Apache-2.0
// Any bytes, read as a camera path, must give an error, or cameras with finite numbers only.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "lf/camera/path/path_yaml.h"

namespace {

// Ends the program with a signal, unlike LF_CHECK, so that libFuzzer keeps the input.
void Require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto path = lf::ParsePathYaml(text, "fuzz.yaml", std::nullopt);
  if (!path) {
    Require(path.error().message.starts_with("fuzz.yaml"));
    Require(path.error().message.find('\n') == std::string::npos);
    return 0;
  }
  Require(path->instants.size() ==
          (path->shutter.exists() ? path->cameras.size() * path->shutter.samples : 0));
  std::vector<lf::RenderCamera> cameras = path->cameras;
  cameras.insert(cameras.end(), path->instants.begin(), path->instants.end());
  for (const lf::RenderCamera& camera : cameras) {
    Require(camera.pinhole.cam_from_world.rotation.isUnitary(1e-6));
    Require(camera.pinhole.cam_from_world.translation.allFinite());
    Require(std::isfinite(camera.pinhole.intrinsics.fx_px) && camera.pinhole.intrinsics.fx_px > 0);
    Require(std::isfinite(camera.aperture.radius_w) && camera.aperture.radius_w >= 0);
    Require(std::isfinite(camera.aperture.rotation_rad));
    Require(camera.focus_plane.normal.allFinite() && std::isfinite(camera.focus_plane.offset_w));
    Require(camera.focus_distance_w > 0);
  }
  return 0;
}
