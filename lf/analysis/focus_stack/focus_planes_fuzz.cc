// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as focus distances.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/core/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto distances_w = lf::ParseFocusDistances(text, "fuzz", 0.01);
  if (!distances_w) return 0;
  LF_CHECK(!distances_w->empty() && distances_w->size() <= lf::kMostFocusPlanes);
  for (const double distance_w : *distances_w)
    LF_CHECK(distance_w >= lf::kLeastFocusDistance_w && distance_w <= lf::kMostFocusDistance_w);
  return 0;
}
