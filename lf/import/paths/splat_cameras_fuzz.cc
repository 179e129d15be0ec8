// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a cameras.json of 3D Gaussian splatting: the result must be an error, or
// cameras that can be rendered.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "lf/core/log.h"
#include "lf/import/paths/frames_path.h"
#include "lf/import/paths/test_camera_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  lf::SetLogLevel(lf::LogLevel::kError);
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::Result<lf::ForeignPath> read = lf::ParseSplatCameras(text, "f/cameras.json", {});
  if (!read) {
    LF_CHECK(read.error().message.starts_with("f/cameras.json: "));
    return 0;
  }
  const lf::Result<lf::CameraPath> path = lf::CompletePath(*std::move(read), "f/cameras.json", {});
  if (path) lf::CheckCameras(*path);
  return 0;
}
