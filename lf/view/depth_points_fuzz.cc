// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a PLY file: the result must be an error that names the file, or points that
// fit into its bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/view/depth_points.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view file(reinterpret_cast<const char*>(bytes), size_bytes);
  constexpr size_t kMost = 100;
  const auto read = lf::ReadPlyPoints(file, "f/p.ply", lf::Vec3(1, 2, 3), 1, kMost);
  if (!read) {
    LF_CHECK(read.error().message.starts_with("f/p.ply: "));
    return 0;
  }
  LF_CHECK(read->count_in_file >= 1 && read->count_in_file <= size_bytes);
  LF_CHECK(!read->places.empty() && read->places.size() <= kMost);
  LF_CHECK(read->colours.size() == read->places.size());
  LF_CHECK(read->spread > 0 && std::isfinite(read->spread));
  LF_CHECK(lf::DepthBytes(*read).size() == 4 + 16 * read->places.size());
  return 0;
}
