// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a camera of MVSNet: the result must be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_mvsnet.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::ExportedCameras cameras;
  const auto parsed = lf::ParseMvsnetCamera(text, "f/a_cam.txt");
  if (!parsed) {
    lf::CheckFault(parsed.error());
    return 0;
  }
  cameras.images = {parsed->image};
  lf::CheckExport(cameras);
  return 0;
}
