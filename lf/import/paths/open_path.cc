// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/open_path.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/import/paths/chan_path.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/import/paths/frames_path.h"
#include "lf/import/paths/map_place.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/import/paths/nerfstudio_poses.h"
#include "lf/import/paths/ngp_path.h"
#include "lf/import/paths/path_kind.h"
#include "lf/import/paths/transmission_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

Result<ForeignPath> ReadForeign(const PathPlace& place, const PathOptions& options) {
  switch (place.kind) {
    case PathKind::kNerfstudio:
      return ReadNerfstudioPath(place.path, options);
    case PathKind::kNerfstudioPoses:
      return ReadNerfstudioPoses(place.path, options);
    case PathKind::kNgp:
      return ReadNgpPath(place.path, options);
    case PathKind::kTransforms:
      return ReadTransformsFrames(place.path, options);
    case PathKind::kSplatCameras:
      return ReadSplatCameras(place.path, options);
    case PathKind::kColmap:
      return ReadColmapFrames(place.path, options);
    case PathKind::kYaml:
    case PathKind::kChan:
      break;
  }
  return ReadChan(place.path, options);
}

// Refuses options that would have no effect.
Result<void> CheckOptions(PathKind kind, const fs::path& path, const PathOptions& options) {
  const bool is_nerfstudio = kind == PathKind::kNerfstudio || kind == PathKind::kNerfstudioPoses;
  if (!options.dataparser_transforms.empty() && !is_nerfstudio)
    return UsageError(fmt::format(
        "{{dataparser_transforms}} is only for camera paths of nerfstudio, but {} is of "
        "another kind: leave the option out",
        path.string()));
  if (options.focal_length_mm && kind != PathKind::kChan && kind != PathKind::kNerfstudioPoses)
    return UsageError(
        fmt::format("{{focal_length_mm}} is only for .chan files without a field of view, but {} "
                    "states it: leave the option out",
                    path.string()));
  if (options.fov_unit && kind != PathKind::kNerfstudio && kind != PathKind::kNgp &&
      kind != PathKind::kChan)
    return UsageError(
        fmt::format("{{fov_unit}} is only for camera paths of nerfstudio and instant-ngp and for "
                    ".chan files, but {} is of another kind: leave the option out",
                    path.string()));
  return {};
}

}  // namespace

PathOptions PathOptionsFor(const LightField& light_field) {
  PathOptions options;
  options.light_field_unit_m = light_field.unit_m;
  options.depth_range = light_field.depth_range;
  options.light_field = light_field.source;
  return options;
}

PathOptions PathOptionsToRender(const LightField& light_field) {
  PathOptions options = PathOptionsFor(light_field);
  options.surface = PathOptions::Surface::kName;
  return options;
}

Result<void> AddFocalSurfaces(const fs::path& path, const LightField& light_field,
                              const SurfaceWork& work, CameraPath* opened) {
  if (!opened->focal_surface) return {};
  return MakeFocalSurfaces(path.parent_path(), NearestCameraDistance(light_field), work, opened);
}

Result<bool> IsPathYaml(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const PathPlace place, FindPath(path));
  return place.kind == PathKind::kYaml;
}

std::vector<fs::path> FilesOfPath(const fs::path& path) {
  std::vector<fs::path> files = {path};
  const auto place = FindPath(path);
  if (!place || place->kind != PathKind::kYaml) return files;
  // The reader of pictures only takes their names, so that the path is not read to its end.
  const auto read = ReadPathFrames(path, std::nullopt, [&](const std::string& picture) {
    files.push_back(path.parent_path() / picture);
    return Result<Transmission>(InputError(""));
  });
  // The path cannot be read to its end if it has a transmission, so that it is read once more.
  const auto whole = read ? read : ReadPathFrames(path, std::nullopt, PicturesBeside(path));
  if (whole && whole->focal_surface())
    for (const FrameId frame : whole->frames().All()) {
      files.push_back(path.parent_path() / FileOfFrame(*whole->focal_surface(), frame.value));
      if (!HasFilePerFrame(*whole->focal_surface())) break;
    }
  return files;
}

Result<CameraPath> OpenPath(const fs::path& path, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const PathPlace place, FindPath(path));
  LF_RETURN_IF_ERROR(CheckOptions(place.kind, path, options));
  CameraPath opened;
  if (place.kind == PathKind::kYaml) {
    LF_ASSIGN_OR_RETURN(opened,
                        ReadPathYaml(path, options.light_field_unit_m, PicturesBeside(path)));
  } else {
    LF_ASSIGN_OR_RETURN(ForeignPath read, ReadForeign(place, options));
    LF_ASSIGN_OR_RETURN(opened, CompletePath(std::move(read), path, options));
  }
  LF_RETURN_IF_ERROR(ReplaceQuantities(options, path, &opened));
  if (opened.focal_surface && options.surface == PathOptions::Surface::kRefuse)
    return InputError(fmt::format(
        "{}: focus.surface: this program knows focus planes only, no focal surfaces: render the "
        "path with lfrenderer, or remove 'focus' from the path to focus on lens.focus_distance",
        path.string()));
  if (opened.focal_surface)
    LF_RETURN_IF_ERROR(PlaceMap(path.parent_path(), opened.unit_m, &*opened.focal_surface));
  if (options.surface == PathOptions::Surface::kMake)
    LF_RETURN_IF_ERROR(
        MakeFocalSurfaces(path.parent_path(), options.camera_distance_w, {}, &opened));
  return opened;
}

}  // namespace lf
