// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a 4x4 matrix: the result must be a valid similarity or an error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/check/similarity.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::Similarity> similarity = lf::ParseSimilarity(text);
  if (!similarity) {
    LF_CHECK(!similarity.error().message.empty());
    return 0;
  }
  LF_CHECK(similarity->scale > 0 && std::isfinite(similarity->scale));
  const lf::Mat3& r = similarity->rotation;
  LF_CHECK((r.transpose() * r - lf::Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-9);
  LF_CHECK(similarity->translation.allFinite());
  return 0;
}
