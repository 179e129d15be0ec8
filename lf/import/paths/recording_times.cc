// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/recording_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "lf/camera/path/path_yaml.h"
#include "lf/core/file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/transmission_file.h"

namespace lf {
namespace fs = std::filesystem;

std::vector<double> RecordingTimesOf(const CameraPath& path) {
  std::set<double> times;
  for (const RenderCamera& camera : path.AllInstants())
    if (camera.recording_time) times.insert(*camera.recording_time);
  return {times.begin(), times.end()};
}

Result<std::vector<double>> RecordingTimesOf(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const bool is_yaml, IsPathYaml(path));
  if (!is_yaml) return std::vector<double>();  // other forms have no such times
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
  // Most paths do not move through time. Their cameras are not computed.
  if (text.find("from") == std::string::npos) return std::vector<double>();
  LF_ASSIGN_OR_RETURN(const PathFrames frames,
                      ParsePathFrames(text, path.string(), std::nullopt, PicturesBeside(path)));
  if (!frames.moves_through_time()) return std::vector<double>();
  PathOptions options;
  options.surface = PathOptions::Surface::kName;
  LF_ASSIGN_OR_RETURN(const CameraPath opened, OpenPath(path, options));
  return RecordingTimesOf(opened);
}

Result<void> FitToOpenTimes(const LightField& light_field, CameraPath* path) {
  if (RecordingTimesOf(*path).empty()) return {};
  if (!light_field.video || !light_field.video->is_of_path)
    return UsageError(fmt::format(
        "the path moves through time (its key time), but {} shows one time: {}",
        light_field.source.string(),
        light_field.video ? "leave {time} out, or remove the key time from the path"
                          : "remove the key time from the path, or give a light field video"));
  if (light_field.slice_times.size() > 1) return {};
  path->ChangeCameras([](RenderCamera* camera) { camera->recording_time.reset(); });
  return {};
}

}  // namespace lf
