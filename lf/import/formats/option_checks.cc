// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/option_checks.h"

#include <fmt/format.h>

namespace lf {
namespace fs = std::filesystem;

std::string_view StanfordOptionOf(const OpenOptions& options) {
  if (options.focal_px) return "{focal_px}";
  if (options.pitch_w) return "{pitch}";
  if (options.grid) return "{grid}";
  if (options.layout) return "{layout}";
  if (options.plane_distance_w) return "{plane_distance}";
  if (options.flip_x) return "{flip_x}";
  if (options.flip_y) return "{flip_y}";
  return "";
}

Result<void> CheckNoStanfordOptions(const fs::path& path, const OpenOptions& options) {
  const std::string_view option = StanfordOptionOf(options);
  if (option.empty()) return {};
  return UsageError(fmt::format(
      "{} is only for folders of images with Stanford names, which lack a part of the "
      "calibration, but {} is a complete calibration: leave the option out, or give the "
      "folder of the images",
      option, path.string()));
}

Result<void> CheckNoFov(const fs::path& path, const OpenOptions& options) {
  if (!options.fov_deg) return {};
  return UsageError(
      fmt::format("{{fov_deg}} is only for poses of Airborne Optical Sectioning, which lack the "
                  "field of view; {} is of another kind: leave the option out",
                  path.string()));
}

Result<void> CheckNoImagesFolder(const fs::path& path, const OpenOptions& options) {
  if (!options.images_folder) return {};
  return UsageError(fmt::format(
      "{{images}} cannot be used with {}, which contains its own images: leave the option out",
      path.string()));
}

}  // namespace lf
