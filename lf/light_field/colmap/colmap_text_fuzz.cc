// SPDX-License-Identifier: Apache-2.0
// Parses any bytes: the result must be an error, or a light field that passes CheckIsSane(). The
// input holds cameras.txt, images.txt and points3D.txt, separated by form feeds.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/log.h"
#include "lf/light_field/colmap/test_colmap.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  lf::SetLogLevel(lf::LogLevel::kError);
  std::string_view rest(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto take = [&rest] {
    const std::string_view file = rest.substr(0, rest.find('\f'));
    rest.remove_prefix(std::min(file.size() + 1, rest.size()));
    return file;
  };
  const std::string_view cameras = take();
  const std::string_view images = take();
  const lf::Result<lf::LightField> light_field = lf::ParseColmap(false, cameras, images, rest);
  if (light_field)
    lf::CheckIsSane(*light_field);
  else
    LF_CHECK(light_field.error().message.starts_with("m/"));
  return 0;
}
