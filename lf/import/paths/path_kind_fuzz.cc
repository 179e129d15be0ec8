// SPDX-License-Identifier: Apache-2.0
// Finds out the form of any bytes as a camera path: the result must be a form, or an error that
// names the file. If the form is a list of poses of nerfstudio, reads them: the result must be an
// error, or cameras that can be rendered.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "lf/core/log.h"
#include "lf/import/paths/nerfstudio_poses.h"
#include "lf/import/paths/path_kind.h"
#include "lf/import/paths/test_camera_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  lf::SetLogLevel(lf::LogLevel::kError);
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::PathKind> kind = lf::PathKindOf(text, "f/p");
  if (!kind) {
    LF_CHECK(kind.error().message.starts_with("f/p: "));
    return 0;
  }
  if (*kind != lf::PathKind::kNerfstudioPoses) return 0;
  lf::Result<lf::ForeignPath> read = lf::ParseNerfstudioPoses(text, "f/p", {});
  if (!read) {
    LF_CHECK(read.error().message.starts_with("f/p: "));
    return 0;
  }
  const lf::Result<lf::CameraPath> path = lf::CompletePath(*std::move(read), "f/p", {});
  if (path) lf::CheckCameras(*path);
  return 0;
}
