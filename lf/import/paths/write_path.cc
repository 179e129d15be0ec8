#include "lf/import/paths/write_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/camera/path/path_yaml_write.h"
#include "lf/core/file.h"
#include "lf/core/value_named.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/import/paths/ngp_path.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

template <class Holds>
bool AnyCamera(const CameraPath& path, const Holds& holds) {
  return std::any_of(path.cameras.begin(), path.cameras.end(), holds);
}

// Adds what the programs of others will not see, because only our keys state it.
void AddUnseen(const CameraPath& path, bool has_lens, std::vector<std::string>* lost) {
  if (!has_lens &&
      AnyCamera(path, [](const RenderCamera& camera) { return camera.aperture.radius_w > 0; }))
    lost->push_back("the lens (only our programs read its lf_ keys)");
  if (AnyCamera(path, [](const RenderCamera& camera) {
        const Intrinsics& k = camera.pinhole.intrinsics;
        return std::abs(k.cx_px - k.width_px / 2.0) > 1e-9 ||
               std::abs(k.cy_px - k.height_px / 2.0) > 1e-9 ||
               std::abs(k.fx_px - k.fy_px) > 1e-12 * k.fx_px || k.skew_px != 0;
      }))
    lost->push_back(
        "the principal point and elements that are no squares (only our programs read their lf_ "
        "keys)");
  if (has_lens && AnyCamera(path, [](const RenderCamera& camera) {
        return camera.aperture.blades > 0 || camera.focus_tilt.horizontal_rad != 0 ||
               camera.focus_tilt.vertical_rad != 0;
      }))
    lost->push_back("the blades and the tilt of the focus (only our programs read their lf_ keys)");
}

Result<std::string> TextOf(const CameraPath& path, const fs::path& file, PathFormat format,
                           const PathOptions& options, std::vector<std::string>* lost) {
  if (format == PathFormat::kYaml) {
    LF_ASSIGN_OR_RETURN(PathYaml yaml, PathYamlOf(path));
    *lost = std::move(yaml.lost);
    return yaml.text;
  }
  AddUnseen(path, format == PathFormat::kNgp, lost);
  if (format == PathFormat::kNgp) {
    LF_ASSIGN_OR_RETURN(const NgpSpace space, NgpSpaceFor("", options));
    return NgpText(path, space);
  }
  if (options.dataparser_transforms.empty()) return NerfstudioText(path, "world");
  LF_ASSIGN_OR_RETURN(const Similarity world_from_trained,
                      WorldFromTrained(options.dataparser_transforms, options.light_field));
  CameraPath trained = path;
  LF_RETURN_IF_ERROR(MovePath(InverseOf(world_from_trained), file, &trained));
  return NerfstudioText(trained, "trained");
}

}  // namespace

std::string_view NameOf(PathFormat format) {
  switch (format) {
    case PathFormat::kYaml:
      return "yaml";
    case PathFormat::kNerfstudio:
      return "nerfstudio";
    case PathFormat::kNgp:
      break;
  }
  return "instant-ngp";
}

std::optional<PathFormat> PathFormatOf(std::string_view name) {
  return ValueNamed(name, {PathFormat::kYaml, PathFormat::kNerfstudio, PathFormat::kNgp});
}

std::optional<PathFormat> PathFormatOfFile(const fs::path& file) {
  const fs::path extension = file.extension();
  if (extension == ".yaml" || extension == ".yml") return PathFormat::kYaml;
  if (extension == ".json") return PathFormat::kNerfstudio;
  return std::nullopt;
}

Result<std::vector<std::string>> WritePath(const CameraPath& path, const fs::path& file,
                                           PathFormat format, const PathOptions& options) {
  std::vector<std::string> lost;
  LF_ASSIGN_OR_RETURN(const std::string text, TextOf(path, file, format, options, &lost));
  LF_RETURN_IF_ERROR(WriteFileAtomically(file, text));
  return lost;
}

Result<void> MovePath(const Similarity& b_from_a, const fs::path& file, CameraPath* path) {
  for (size_t i = 0; i < path->frame_count(); ++i) {
    RenderCamera& camera = path->cameras[i];
    camera.pinhole.cam_from_world = PoseIn(b_from_a, camera.pinhole.cam_from_world);
    double largest_w = 0;
    for (double* const length : {&camera.aperture.radius_w, &camera.focal_length_w,
                                 &camera.sensor_width_w, &camera.focus_distance_w}) {
      *length *= b_from_a.scale;
      largest_w = std::max(largest_w, *length);
    }
    if (!(camera.pinhole.cam_from_world.translation.cwiseAbs().maxCoeff() <= 1e12) ||
        !(largest_w <= 1e9))
      return InputError(
          fmt::format("{}: frame {} would be moved beyond 1e12 world units, or its lens would be "
                      "larger than 1e9: reduce the translation or the scale",
                      file.string(), i + 1));
    camera.focus_plane = FocusPlane(camera.pinhole, camera.focus_distance_w, camera.focus_tilt);
  }
  return {};
}

}  // namespace lf
