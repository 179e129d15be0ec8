// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/nerfstudio_poses.h"

#include <string>

#include "lf/core/file.h"
#include "lf/import/paths/json_list.h"
#include "lf/import/paths/nerfstudio_path.h"

namespace lf {

Result<ForeignPath> ParseNerfstudioPoses(std::string_view text, const std::filesystem::path& file,
                                         const PathOptions& options) {
  ForeignPath path;
  path.fps = FpsOr(options, &path);
  const Intrinsics intrinsics = IntrinsicsOfLens(options, ResolutionOr(options, &path), &path);
  const auto read_frame = [&](const JsonFields& frame) -> Result<void> {
    LF_ASSIGN_OR_RETURN(const RigidTransform pose, PoseOfMatrix(frame, "transform"));
    ForeignCamera camera;
    camera.pinhole = {intrinsics, pose};
    path.cameras.push_back(camera);
    return {};
  };
  const auto read_top = [](const JsonFields&) { return Result<void>(); };
  LF_RETURN_IF_ERROR(ReadJsonList(text, file, "poses", read_top, read_frame));
  return path;
}

Result<ForeignPath> ReadNerfstudioPoses(const std::filesystem::path& file,
                                        const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMaxPathBytes));
  LF_ASSIGN_OR_RETURN(ForeignPath path, ParseNerfstudioPoses(text, file, options));
  LF_RETURN_IF_ERROR(UndoTraining(file, options, false, &path));
  return path;
}

}  // namespace lf
