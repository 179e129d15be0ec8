// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as a pose and as the intrinsics of NSVF: the results must be valid or errors.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lf/import/exports/fuzz_exports.h"
#include "lf/import/exports/read_nsvf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const auto pose = lf::ParseNsvfPose(text, "f/pose/0.txt");
  const auto intrinsics = lf::ParseNsvfIntrinsics(text, "f/intrinsics.txt");
  lf::ExportedCameras cameras;
  cameras.images = {
      {"0.png", intrinsics ? *intrinsics : lf::Intrinsics{}, pose ? *pose : lf::RigidTransform{}}};
  if (!pose) lf::CheckFault(pose.error());
  if (!intrinsics) lf::CheckFault(intrinsics.error());
  lf::CheckExport(cameras);
  return 0;
}
