// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a camera of nerfies: the result must be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_nerfies.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::ExportedCameras cameras;
  const auto parsed = lf::ParseNerfiesCamera(text, "f/a.json");
  if (!parsed) {
    lf::CheckFault(parsed.error());
    return 0;
  }
  cameras.images = {*parsed};
  lf::CheckExport(cameras);
  return 0;
}
