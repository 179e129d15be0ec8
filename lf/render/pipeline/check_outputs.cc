// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/check_outputs.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "lf/film/develop/video.h"
#include "lf/light_field/model/image_files.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/state/run_state.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the files that the render may write or remove, except for plates and rebinned rays in its
// state.
std::vector<OutputFile> OutputsOf(const Package& package, const RenderOptions& options) {
  const FolderOptions& to = options.folder;
  const std::string state = NameOfState(package.name, options.film.shard);
  const fs::path partial = to.output_folder / "partial" / state;
  const std::vector<FrameId> frames = options.frames.empty() ? package.FrameIds() : options.frames;
  const std::vector<std::string> parts =
      state.empty() ? std::vector<std::string>() : std::vector<std::string>{state};
  std::vector<OutputFile> outputs = OutputsOfFilm(to.output_folder, frames, to.format, parts);
  outputs.emplace_back(partial / "run.json", "the state of the render");
  for (const FrameId frame : frames) {
    const fs::path unfinished = FramePath(partial, frame, to.format);
    outputs.emplace_back(unfinished, "an unfinished frame");
    outputs.emplace_back(fs::path(unfinished).replace_extension(".json"), "the state of a frame");
    if (to.keep_plates)
      outputs.emplace_back(
          FramePath(to.output_folder, frame, to.format).replace_extension(".plate"), "a plate");
  }
  for (const fs::path& more : to.more_outputs) outputs.emplace_back(more);
  return outputs;
}

// Returns the videos beside the calibration of a light field video, which the render must not
// replace by its own. Its LF images are decoded frames, which lie elsewhere.
std::vector<fs::path> RecordedVideosOf(const LightField& light_field) {
  std::vector<fs::path> videos;
  if (!light_field.video || light_field.source.empty()) return videos;
  std::error_code error;
  const fs::path folder = fs::is_directory(light_field.source, error)
                              ? light_field.source
                              : fs::absolute(light_field.source).parent_path();
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (IsVideoName(it->path())) videos.push_back(it->path());
  return videos;
}

}  // namespace

std::vector<fs::path> FilesOfLightField(const LightField& light_field, const fs::path& opened) {
  std::vector<fs::path> files = {opened, opened / "transforms.json"};
  if (HoldsPackedStore(light_field)) {
    files.push_back(light_field.folder);
    return files;
  }
  for (const auto* names : {&light_field.image_names, &light_field.mask_names})
    for (const std::string& name : *names)
      if (!name.empty()) files.push_back(light_field.folder / name);
  for (fs::path& video : RecordedVideosOf(light_field)) files.push_back(std::move(video));
  return files;
}

std::vector<OutputFile> OutputsOfFilm(const fs::path& folder, const std::vector<FrameId>& frames,
                                      FrameFormat format, const std::vector<std::string>& parts) {
  std::vector<OutputFile> outputs = {{folder / kContactSheet, "the contact sheet"},
                                     {folder / "report.json", "the report"}};
  for (const std::string& part : parts) {
    outputs.emplace_back(folder / ("contact_sheet-" + part + ".png"), "a contact sheet");
    outputs.emplace_back(folder / ("report-" + part + ".json"), "a report");
  }
  for (const FrameId frame : frames)
    outputs.emplace_back(FramePath(folder, frame, format), "a frame");
  return outputs;
}

Result<OutputFiles> MakeFilmOutputs(std::vector<OutputFile> outputs, const fs::path& folder,
                                    const std::optional<fs::path>& video) {
  if (!video) return OutputFiles::Make(std::move(outputs));
  std::error_code error;
  if (fs::exists(*video, error)) LF_RETURN_IF_ERROR(CheckVideoTarget(*video));
  for (const char* const state : {"partial", "cluster"})
    if (LiesIn(*video, folder / state))
      return UsageError(fmt::format(
          "{{video {}}}: lies in {}, which belongs to the render: give another {{video}}",
          video->string(), (folder / state).string()));
  outputs.emplace_back(*video, "the video", "{video}");
  return OutputFiles::Make(std::move(outputs));
}

Result<void> CheckOutputs(const Package& package, const RenderOptions& options) {
  const FolderOptions& to = options.folder;
  LF_ASSIGN_OR_RETURN(const OutputFiles outputs,
                      MakeFilmOutputs(OutputsOf(package, options), to.output_folder, to.video));
  LF_RETURN_IF_ERROR(outputs.CheckReplacesNone(to.inputs));
  const LightField& field = package.light_field;
  LF_RETURN_IF_ERROR(outputs.CheckReplacesNone(RecordedVideosOf(field)));
  LF_RETURN_IF_ERROR(outputs.CheckReplacesNone(field.folder, ImageFileNames(field), "an LF image"));
  return outputs.CheckReplacesNone(field.folder, field.mask_names, "a mask of an LF image");
}

}  // namespace lf
