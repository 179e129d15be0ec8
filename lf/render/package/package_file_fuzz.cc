// SPDX-License-Identifier: Apache-2.0
// Any bytes, read as a file, must give a package or an error. A package must have only valid
// cameras and ranks. The checksum footer is not checked, because otherwise no damaged bytes would
// reach the parser.
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "lf/core/check.h"
#include "lf/render/package/package_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("lf_package_fuzz." + std::to_string(::getpid()) + ".lfp");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size_bytes));
  const lf::Result<lf::Package> package = lf::ReadPackage(path, {.check_seal = false});
  if (package) {
    const lf::LightField& field = package->light_field;
    LF_CHECK(field.size() == package->images.size());
    LF_CHECK(field.size() == package->ranks.of_images.size());
    LF_CHECK(field.size() - lf::RecordedCount(field) <= package->whole_virtual_count);
    for (size_t i = 0; i < field.size(); ++i) {
      LF_CHECK(field.cameras[i].intrinsics_index < field.intrinsics.size());
      LF_CHECK(package->ranks.of_images[i] < package->ranks.end);
      LF_CHECK(field.cameras[i].cam_from_world.translation.allFinite());
    }
    for (const lf::PackageFrame& frame : package->frames)
      LF_CHECK(std::isfinite(package->path.Camera(frame.id).aperture.radius_w));
    for (const lf::FrameSurroundings& around : package->surroundings)
      LF_CHECK(around.camera_distance_w >= 0 && around.middle_world.allFinite());
  } else {
    LF_CHECK(package.error().message.starts_with(path.string() + ": "));
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return 0;
}
