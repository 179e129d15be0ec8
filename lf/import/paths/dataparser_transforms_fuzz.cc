// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a dataparser_transforms.json of nerfstudio: the result must be an error, or a
// similarity that can be undone.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "lf/core/check.h"
#include "lf/import/paths/nerfstudio_path.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::filesystem::path file = "f/d.json";
  lf::JsonObject object;
  if (!object.Parse(std::string(reinterpret_cast<const char*>(bytes), size_bytes))) return 0;
  const lf::Result<lf::Similarity> trained = lf::TrainedFromOriginal(lf::JsonFields(object, file));
  if (!trained) {
    LF_CHECK(trained.error().message.starts_with("f/d.json: "));
    return 0;
  }
  const lf::Similarity back = lf::InverseOf(*trained);
  LF_CHECK(back.scale > 0 && std::isfinite(back.scale) && back.translation.allFinite());
  const lf::Mat3 error = back.rotation * trained->rotation - lf::Mat3::Identity();
  LF_CHECK(error.cwiseAbs().maxCoeff() < 1e-11);
  return 0;
}
