#include "lf/import/paths/open_path.h"

#include <fmt/format.h>

#include <utility>

#include "lf/camera/path/path_yaml.h"
#include "lf/core/byte_stream.h"
#include "lf/import/paths/chan_path.h"
#include "lf/import/paths/foreign_path.h"
#include "lf/import/paths/nerfstudio_path.h"
#include "lf/import/paths/ngp_path.h"
#include "lf/import/paths/path_kind.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the form of a file. A file that cannot be opened counts as our own, whose reader reports
// the error.
Result<PathKind> PathKindOfFile(const fs::path& path) {
  Result<ByteStream> stream = ByteStream::Open(path);
  if (!stream) return PathKind::kYaml;
  return PathKindOf(stream->Window(), path);
}

Result<ForeignPath> ReadForeign(PathKind kind, const fs::path& path, const PathOptions& options) {
  switch (kind) {
    case PathKind::kNerfstudio:
      return ReadNerfstudioPath(path, options);
    case PathKind::kNgp:
      return ReadNgpPath(path, options);
    case PathKind::kYaml:
    case PathKind::kChan:
      break;
  }
  return ReadChan(path, options);
}

// Refuses options that would have no effect.
Result<void> CheckOptions(PathKind kind, const fs::path& path, const PathOptions& options) {
  if (!options.dataparser_transforms.empty() && kind != PathKind::kNerfstudio)
    return UsageError(
        fmt::format("--dataparser-transforms is only for camera paths of nerfstudio, but {} is of "
                    "another kind: leave the option out",
                    path.string()));
  if (options.focal_length_mm && kind != PathKind::kChan)
    return UsageError(
        fmt::format("--focal-length-mm is only for .chan files without a field of view, but {} "
                    "states it: leave the option out",
                    path.string()));
  return {};
}

}  // namespace

PathOptions PathOptionsFor(const LightField& light_field, const fs::path& path) {
  PathOptions options;
  options.light_field_unit_m = light_field.unit_m;
  options.depth_range = light_field.depth_range;
  options.light_field = path;
  return options;
}

Result<bool> IsPathYaml(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const PathKind kind, PathKindOfFile(path));
  return kind == PathKind::kYaml;
}

Result<CameraPath> OpenPath(const fs::path& path, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const PathKind kind, PathKindOfFile(path));
  LF_RETURN_IF_ERROR(CheckOptions(kind, path, options));
  CameraPath opened;
  if (kind == PathKind::kYaml) {
    LF_ASSIGN_OR_RETURN(opened, ReadPathYaml(path, options.light_field_unit_m));
  } else {
    LF_ASSIGN_OR_RETURN(ForeignPath read, ReadForeign(kind, path, options));
    LF_ASSIGN_OR_RETURN(opened, CompletePath(std::move(read), path, options));
  }
  LF_RETURN_IF_ERROR(ReplaceQuantities(options, path, &opened));
  return opened;
}

}  // namespace lf
