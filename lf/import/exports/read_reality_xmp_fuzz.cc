// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as an XMP file of RealityCapture: the result must be a valid camera, none, or an
// error.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/log.h"
#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_reality_xmp.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  lf::SetLogLevel(lf::LogLevel::kError);
  lf::Result<std::optional<lf::RealitySidecar>> sidecar = lf::ParseRealityXmp(text, "f/a.xmp");
  if (!sidecar) {
    LF_CHECK(sidecar.error().message.starts_with("f/a.xmp: "));
    return 0;
  }
  if (!*sidecar) return 0;
  lf::ExportedCameras cameras;
  cameras.folder = "f";
  cameras.counts_from_middle = cameras.in_larger_sides = true;
  cameras.images.push_back(std::move((*sidecar)->image));
  lf::CheckExport(std::move(cameras));
  return 0;
}
