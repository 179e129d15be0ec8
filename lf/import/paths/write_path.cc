// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/write_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "lf/camera/path/path_yaml_write.h"
#include "lf/core/byte_stream.h"
#include "lf/core/file.h"
#include "lf/core/value_named.h"
#include "lf/import/paths/chan_path.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/import/paths/ngp_path.h"
#include "lf/import/paths/path_kind.h"
#include "lf/import/paths/usda_path.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

template <class Holds>
bool AnyCamera(const CameraPath& path, const Holds& holds) {
  return std::any_of(path.cameras.begin(), path.cameras.end(), holds);
}

bool HasLens(const RenderCamera& camera) { return camera.aperture.radius_w > 0; }

bool IsOffCentre(const RenderCamera& camera) {
  const Intrinsics& k = camera.pinhole.intrinsics;
  return std::abs(k.cx_px - k.width_px / 2.0) > 1e-9 ||
         std::abs(k.cy_px - k.height_px / 2.0) > 1e-9 ||
         std::abs(k.fx_px - k.fy_px) > 1e-12 * k.fx_px || k.skew_px != 0;
}

bool HasBladesOrTilt(const RenderCamera& camera) {
  return camera.aperture.blades > 0 || HasShape(camera) || camera.focus_tilt.horizontal_rad != 0 ||
         camera.focus_tilt.vertical_rad != 0;
}

bool IsSkewed(const RenderCamera& camera) { return camera.pinhole.intrinsics.skew_px != 0; }

// Returns what programs of others do not find in a file. Our programs restore it from JSON.
std::vector<std::string> LostIn(PathFormat format, const CameraPath& path) {
  std::vector<std::string> lost;
  const bool is_json = format == PathFormat::kNerfstudio || format == PathFormat::kNgp;
  const char* const note = is_json ? " (only our programs read its lf_ keys)" : "";
  const auto add = [&](bool holds, const char* what) {
    if (holds) lost.push_back(fmt::format("{}{}", what, note));
  };
  if (format == PathFormat::kUsda) {
    lost.push_back("the resolution");
    add(AnyCamera(path, IsSkewed), "skew");
  } else {
    add(AnyCamera(path, IsOffCentre), "the principal point and elements that are no squares");
  }
  if (format == PathFormat::kChan)
    lost.push_back("resolution, frame rate, unit and order of the rotations");
  if (AnyCamera(path, [](const RenderCamera& camera) { return camera.transmission != nullptr; }))
    lost.push_back("the transmission of the lens (only YAML keeps it)");
  if (format == PathFormat::kNgp || format == PathFormat::kUsda)
    add(AnyCamera(path, HasBladesOrTilt),
        "the shape of the opening, the hood and the tilt of the focus");
  else
    add(AnyCamera(path, HasLens), "the lens");
  if (path.focal_surface) lost.emplace_back("the focal surface (only YAML keeps it)");
  if (path.views > 1)
    lost.push_back(fmt::format(
        "the moments of the film: the {} views of each moment are frames that follow each other{}",
        path.views, note));
  if (is_json) add(path.first_frame != 1, "the number of the first frame");
  if (path.shutter.exists())
    lost.emplace_back("the shutter, so that a moving camera does not blur its frames");
  if (path.cameras.front().recording_time)
    lost.emplace_back("the time of the light field video that its frames show");
  return lost;
}

Result<std::string> NerfstudioTextFor(const CameraPath& path, const fs::path& file,
                                      const PathOptions& options) {
  if (options.dataparser_transforms.empty()) return NerfstudioText(path, "world");
  LF_ASSIGN_OR_RETURN(const Similarity world_from_trained,
                      WorldFromTrained(options.dataparser_transforms, options.light_field));
  CameraPath trained = path;
  LF_RETURN_IF_ERROR(MovePath(InverseOf(world_from_trained), file, &trained));
  return NerfstudioText(trained, "trained");
}

Result<std::string> NgpTextFor(const CameraPath& path, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const NgpSpace space, NgpSpaceFor("", options));
  return NgpText(path, space);
}

Result<std::string> TextOf(const CameraPath& path, const fs::path& file, PathFormat format,
                           const PathOptions& options, std::vector<std::string>* lost) {
  if (format == PathFormat::kYaml) {
    LF_ASSIGN_OR_RETURN(PathYaml yaml, PathYamlOf(path));
    *lost = std::move(yaml.lost);
    return yaml.text;
  }
  *lost = LostIn(format, path);
  if (format == PathFormat::kNgp) return NgpTextFor(path, options);
  if (format == PathFormat::kChan) return ChanText(path, options.rotation_order);
  if (format == PathFormat::kUsda) return UsdaText(path);
  return NerfstudioTextFor(path, file, options);
}

// Moves the camera of frame `index` + 1.
Result<void> MoveCamera(const Similarity& b_from_a, const fs::path& file, size_t index,
                        RenderCamera* camera) {
  camera->pinhole.cam_from_world = PoseIn(b_from_a, camera->pinhole.cam_from_world);
  double largest_w = 0;
  for (double* const length :
       {&camera->aperture.radius_w, &camera->focal_length_w, &camera->sensor_width_w,
        &camera->focus_distance_w, &camera->hood.distance_w, &camera->hood.radius_w}) {
    *length *= b_from_a.scale;
    largest_w = std::max(largest_w, *length);
  }
  if (!(camera->pinhole.cam_from_world.translation.cwiseAbs().maxCoeff() <= 1e12) ||
      !(largest_w <= 1e9))
    return InputError(
        fmt::format("{}: frame {} would be moved beyond 1e12 world units, or its lens would be "
                    "larger than 1e9: reduce the translation or the scale",
                    file.string(), index + 1));
  camera->focus_plane = FocusPlane(camera->pinhole, camera->focus_distance_w, camera->focus_tilt);
  return {};
}

// Returns true if the file is a path in one of the forms that we write. kInput: it cannot be read.
Result<bool> IsCameraPath(const fs::path& file) {
  LF_ASSIGN_OR_RETURN(ByteStream stream, ByteStream::Open(file));
  const std::string_view text = stream.Window();
  LF_RETURN_IF_ERROR(stream.Status());
  if (text.starts_with(kUsdaStart)) return true;
  const Result<PathKind> kind = PathKindOf(text, file);
  if (!kind) return false;
  switch (*kind) {
    case PathKind::kNerfstudio:
    case PathKind::kNgp:
      return true;
    case PathKind::kYaml:
      return text.find("lfpath") != std::string_view::npos;
    case PathKind::kChan:
      return ReadChan(file, {}).has_value();
    case PathKind::kNerfstudioPoses:
    case PathKind::kTransforms:
    case PathKind::kSplatCameras:
    case PathKind::kColmap:
      break;
  }
  return false;
}

}  // namespace

std::string_view NameOf(PathFormat format) {
  switch (format) {
    case PathFormat::kYaml:
      return "yaml";
    case PathFormat::kNerfstudio:
      return "nerfstudio";
    case PathFormat::kNgp:
      return "instant-ngp";
    case PathFormat::kChan:
      return "chan";
    case PathFormat::kUsda:
      break;
  }
  return "usda";
}

std::optional<PathFormat> PathFormatOf(std::string_view name) {
  return ValueNamed(name, {PathFormat::kYaml, PathFormat::kNerfstudio, PathFormat::kNgp,
                           PathFormat::kChan, PathFormat::kUsda});
}

std::optional<PathFormat> PathFormatOfFile(const fs::path& file) {
  const fs::path extension = file.extension();
  if (extension == ".yaml" || extension == ".yml") return PathFormat::kYaml;
  if (extension == ".json") return PathFormat::kNerfstudio;
  if (extension == ".chan") return PathFormat::kChan;
  if (extension == ".usda") return PathFormat::kUsda;
  return std::nullopt;
}

bool HoldsShift(PathFormat format) { return format != PathFormat::kChan; }

Result<void> CheckReplacesPath(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::is_empty(file, error)) return {};
  LF_ASSIGN_OR_RETURN(const bool is_path, IsCameraPath(file));
  if (is_path) return {};
  return UsageError(
      fmt::format("{}: exists, and is not a camera path: give another name, or remove the file",
                  file.string()));
}

Result<std::vector<std::string>> WritePath(const CameraPath& path, const fs::path& file,
                                           PathFormat format, const PathOptions& options) {
  if (path.views > 1 && !HoldsShift(format))
    return UsageError(fmt::format(
        "{}: the format {} has no place for the {} views of each moment and the shift of "
        "their plates: use {{format yaml}}, nerfstudio, instant-ngp or usda",
        file.string(), NameOf(format), path.views));
  std::vector<std::string> lost;
  LF_ASSIGN_OR_RETURN(const std::string text, TextOf(path, file, format, options, &lost));
  LF_RETURN_IF_ERROR(WriteFileAtomically(file, text));
  return lost;
}

Result<void> MovePath(const Similarity& b_from_a, const fs::path& file, CameraPath* path) {
  for (size_t i = 0; i < path->frame_count(); ++i)
    LF_RETURN_IF_ERROR(MoveCamera(b_from_a, file, i, &path->cameras[i]));
  if (path->focal_surface) {
    FocalSurfaceSource& source = *path->focal_surface;
    source.origin_w = b_from_a.scale * (b_from_a.rotation * source.origin_w) + b_from_a.translation;
    for (Vec3* const axis : {&source.right_w, &source.down_w})
      *axis = b_from_a.scale * (b_from_a.rotation * *axis);
    source.up = b_from_a.rotation * source.up;
    source.scale *= b_from_a.scale;
    source.offset_w *= b_from_a.scale;
  }
  for (size_t i = 0; i < path->instants.size(); ++i)
    LF_RETURN_IF_ERROR(MoveCamera(b_from_a, file, i / path->shutter.samples, &path->instants[i]));
  return {};
}

}  // namespace lf
