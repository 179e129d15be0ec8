// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a camera of Polycam: the result must be valid cameras or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/core/log.h"
#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_polycam.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::SetLogLevel(lf::LogLevel::kError);
  const lf::Result<lf::ExportedImage> image = lf::ParsePolycamCamera(text, "f/7.json");
  if (!image) {
    LF_CHECK(image.error().message.starts_with("f/7.json: "));
    return 0;
  }
  lf::ExportedCameras cameras;
  cameras.images = {*image};
  lf::CheckExport(cameras);
  return 0;
}
