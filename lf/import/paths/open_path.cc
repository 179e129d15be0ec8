#include "lf/import/paths/open_path.h"

#include <utility>

#include "lf/camera/path/path_yaml.h"
#include "lf/core/byte_stream.h"
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

Result<CameraPath> ReadOf(PathKind kind, const fs::path& path, const PathOptions& options) {
  if (kind == PathKind::kYaml) return ReadPathYaml(path, options.light_field_unit_m);
  LF_ASSIGN_OR_RETURN(ForeignPath read, kind == PathKind::kNgp ? ReadNgpPath(path, options)
                                                               : ReadNerfstudioPath(path, options));
  return CompletePath(std::move(read), path, options);
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
  LF_ASSIGN_OR_RETURN(CameraPath opened, ReadOf(kind, path, options));
  LF_RETURN_IF_ERROR(ReplaceQuantities(options, path, &opened));
  return opened;
}

}  // namespace lf
