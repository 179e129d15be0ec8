// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a camera path of nerfstudio: the result must be an error, or cameras that can
// be rendered.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "lf/core/log.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/import/paths/test_camera_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  lf::SetLogLevel(lf::LogLevel::kError);
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  bool is_world = false;
  lf::Result<lf::ForeignPath> read = lf::ParseNerfstudioPath(text, "f/p.json", {}, &is_world);
  if (!read) {
    LF_CHECK(read.error().message.starts_with("f/p.json: "));
    return 0;
  }
  const lf::Result<lf::CameraPath> path = lf::CompletePath(*std::move(read), "f/p.json", {});
  if (path) lf::CheckCameras(*path);
  return 0;
}
