// SPDX-License-Identifier: Apache-2.0
// Parses any bytes: the result must be an error, or a light field that passes CheckIsSane(). The
// input holds two uint16, the sizes of cameras.bin and images.bin, followed by cameras.bin,
// images.bin and points3D.bin.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "lf/light_field/colmap/test_colmap.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  uint16_t sizes[2];
  if (size_bytes < sizeof(sizes)) return 0;
  std::memcpy(sizes, bytes, sizeof(sizes));
  std::string_view rest(reinterpret_cast<const char*>(bytes) + sizeof(sizes),
                        size_bytes - sizeof(sizes));
  const auto take = [&rest](size_t size) {
    const std::string_view file = rest.substr(0, size);
    rest.remove_prefix(file.size());
    return file;
  };
  const std::string_view cameras = take(sizes[0]);
  const std::string_view images = take(sizes[1]);
  const lf::Result<lf::LightField> light_field = lf::ParseColmap(true, cameras, images, rest);
  if (light_field)
    lf::CheckIsSane(*light_field);
  else
    LF_CHECK(light_field.error().message.starts_with("m/"));
  return 0;
}
