// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/focus_stack/focus_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/film/develop/file_inputs.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/develop/video.h"
#include "lf/pixels/files/exr_parts.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/setup_inputs.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPlanes = "planes.json";

std::string PartName(FrameId plane) { return fmt::format("focus_{:04}", plane.value); }

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// Returns true if the folder is missing, empty, or one that RenderFocusStack() has left: with a
// state, a report, or the densified light field that is to be rendered.
bool IsOurs(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return true;
  if (fs::is_directory(folder / "partial", error) || Exists(folder / "report.json")) return true;
  return std::any_of(fs::directory_iterator(folder, error), fs::directory_iterator(),
                     [](const fs::directory_entry& entry) {
                       return entry.path().filename().string().starts_with("densified.lfs");
                     });
}

Result<void> CheckFile(const FocusStackOptions& options) {
  const FolderOptions& folder = options.render.folder;
  const fs::path partial = StackFolder(options.output);
  if (!IsOurs(partial))
    return UsageError(fmt::format(
        "{}: is a folder of something else, but the render of {} keeps its state in a folder of "
        "this name: move it, or give another {{output}}",
        partial.string(), options.output.string()));
  std::error_code error;
  if (fs::is_directory(options.output, error))
    return UsageError(
        fmt::format("{}: is a folder: give the name of a file, or of a folder without the "
                    "extension {}",
                    options.output.string(), options.output.extension().string()));
  if (Exists(options.output) && !folder.overwrite && !(folder.resume && Exists(partial)))
    return UsageError(
        fmt::format("{}: exists already: give another name, or replace it with {{overwrite}}",
                    options.output.string()));
  if (FormOfStack(options.output) != FocusStackForm::kVideo) return {};
  LF_RETURN_IF_ERROR(CheckVideoTool());
  return CheckVideoTarget(options.output, "{output}");
}

// Returns the error of a file whose planes are not those of the stack.
Result<void> CheckPlanes(const CameraPath& stack, const FocusStackOptions& options) {
  const Result<std::vector<double>> distances_w =
      NumbersOfParts(options.output, "lf:focus_distance_w");
  const auto refuse = [&options](const std::string& why) {
    return CannotResume(options.output, why);
  };
  if (!distances_w) return refuse("is no focus stack");
  if (distances_w->size() != stack.frame_count())
    return refuse(fmt::format("has {} planes, and this call asks for {}", distances_w->size(),
                              stack.frame_count()));
  for (size_t i = 0; i < distances_w->size(); ++i) {
    const double asked_w = stack.Camera(FrameId{static_cast<uint32_t>(i + 1)}).focus_distance_w;
    if ((*distances_w)[i] != asked_w)
      return refuse(fmt::format("its plane {} is at {} world units, and this call asks for {}",
                                i + 1, (*distances_w)[i], asked_w));
  }
  return {};
}

// Returns the planes in the order in which a video shows them.
std::vector<FrameId> ShownPlanes(size_t count, bool back_and_forth) {
  std::vector<FrameId> planes;
  for (size_t i = 1; i <= count; ++i) planes.push_back(FrameId{static_cast<uint32_t>(i)});
  if (back_and_forth)
    for (size_t i = count - 1; i > 1; --i) planes.push_back(FrameId{static_cast<uint32_t>(i)});
  return planes;
}

// Writes the outputs that are made of the frames of a whole stack.
class StackOutputs {
 public:
  StackOutputs(const CameraPath& stack, const FocusStackOptions& options, const fs::path& folder)
      : stack_(stack), options_(options), folder_(folder) {}

  Result<void> Write() const {
    switch (FormOfStack(options_.output)) {
      case FocusStackForm::kFolder:
        return WriteFileAtomically(folder_ / kPlanes, FocusPlanesJson(stack_, options_));
      case FocusStackForm::kExr:
        return WriteExrFile();
      case FocusStackForm::kVideo:
        break;
    }
    return WriteVideo();
  }

 private:
  bool IsStopped() const {
    return options_.render.signals != nullptr && options_.render.signals->stop;
  }
  fs::path PathOf(FrameId plane) const {
    return FramePath(folder_, plane, options_.render.folder.format);
  }

  Result<void> WriteExrFile() const {
    std::vector<ExrPart> parts;
    for (const FrameId plane : ShownPlanes(stack_.frame_count(), false))
      parts.push_back({PathOf(plane), PartName(plane)});
    return JoinExr(options_.output, parts, [this] { return IsStopped(); },
                   {{kInputsText, TextOfInputs(options_.inputs)}});
  }

  Result<void> WriteVideo() const {
    const Intrinsics& plate = stack_.cameras.front().pinhole.intrinsics;
    LF_ASSIGN_OR_RETURN(
        const std::unique_ptr<VideoWriter> writer,
        VideoWriter::Open(options_.output, plate.width_px, plate.height_px, stack_.fps));
    for (const FrameId plane : ShownPlanes(stack_.frame_count(), options_.back_and_forth)) {
      if (IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted at the video"};
      LF_ASSIGN_OR_RETURN(const Image<uint8_t> picture,
                          ReadDisplayImage(PathOf(plane), options_.render.folder.picture.colours));
      LF_RETURN_IF_ERROR(writer->Add(picture));
    }
    return writer->Close(TextOfInputs(options_.inputs));
  }

  const CameraPath& stack_;
  const FocusStackOptions& options_;
  const fs::path& folder_;
};

}  // namespace

FocusStackForm FormOfStack(const fs::path& output) {
  if (output.extension() == ".exr") return FocusStackForm::kExr;
  return IsVideoName(output) ? FocusStackForm::kVideo : FocusStackForm::kFolder;
}

fs::path StackFolder(const fs::path& output) {
  if (FormOfStack(output) == FocusStackForm::kFolder) return output;
  return output.string() + ".partial";
}

Result<void> CheckFocusStack(const LightField& light_field, const FocusStackOptions& options) {
  const bool is_folder = FormOfStack(options.output) == FocusStackForm::kFolder;
  std::vector<fs::path> inputs = FilesOfLightField(light_field, light_field.folder);
  const std::vector<fs::path>& others = options.render.folder.inputs;
  inputs.insert(inputs.end(), others.begin(), others.end());
  LF_RETURN_IF_ERROR(
      CheckOutputFiles({is_folder ? options.output / kPlanes : options.output}, inputs));
  return is_folder ? Result<void>() : CheckFile(options);
}

Result<bool> IsFinishedStack(const CameraPath& stack, const FocusStackOptions& options) {
  const FocusStackForm form = FormOfStack(options.output);
  std::error_code error;
  if (form == FocusStackForm::kFolder || !options.render.folder.resume ||
      !fs::is_regular_file(options.output, error) || Exists(StackFolder(options.output)))
    return false;
  const auto refuse = [&options](const std::string& why) {
    return CannotResume(options.output, why);
  };
  if (form == FocusStackForm::kExr) LF_RETURN_IF_ERROR(CheckPlanes(stack, options));
  const std::optional<FileInputs> inputs = ReadInputs(options.output);
  if (!inputs) return refuse("does not tell how it was made");
  const auto difference = FirstDifference(*inputs, InputsOfText(TextOfInputs(options.inputs)));
  if (difference) return refuse(difference->Text("was made with", "and this call has"));
  return true;
}

Result<RunInputs> StackInputs(const LightField& light_field, const CameraPath& stack,
                              const FocusStackOptions& options, bool densifies) {
  const FilmSettings& film = options.render.film;
  RunChoices choices;
  LF_ASSIGN_OR_RETURN(choices.pixels, PixelsOf(light_field));
  choices.film = film;
  choices.format = NameOf(options.render.folder.format);
  choices.look = options.render.folder.picture;
  const std::string cameras = HashOfCameras(stack);
  RunInputs inputs = InputsOfRays(IdentityOf(light_field), light_field.encoding, choices);
  for (const RunInputs& more : {InputsOfSlabs(film, stack), InputsOfPicture(choices)})
    inputs.insert(inputs.end(), more.begin(), more.end());
  inputs.emplace_back("cameras", cameras);
  inputs.emplace_back("densify", densifies ? "on" : "off");
  if (FormOfStack(options.output) != FocusStackForm::kVideo) return inputs;
  inputs.emplace_back("video.fps", fmt::format("{}", stack.fps));
  inputs.emplace_back("video.back_and_forth", options.back_and_forth ? "on" : "off");
  return inputs;
}

Result<RenderReport> RenderFocusStack(Package package, const FocusStackOptions& options,
                                      ThreadPool& pool,
                                      const std::function<void(const RenderProgress&)>& progress) {
  LF_CHECK(options.render.frames.empty());
  const bool is_file = FormOfStack(options.output) != FocusStackForm::kFolder;
  const fs::path folder = StackFolder(options.output);
  const CameraPath stack = package.path;
  LF_RETURN_IF_ERROR(CheckFocusStack(package.light_field, options));
  const StackOutputs outputs(stack, options, folder);
  RenderOptions render = options.render;
  render.folder.output_folder = folder;
  render.folder.complete = [&outputs] { return outputs.Write(); };
  if (is_file) render.folder.contact_sheet = false;
  if (!is_file) render.folder.more_outputs = {folder / kPlanes};
  Result<RenderReport> report = Render(std::move(package), render, pool, progress);
  if (!report || !is_file) return report;
  std::error_code error;
  fs::remove_all(folder, error);
  if (error)
    LogWarning("{}: cannot be removed: {}; it is no longer needed", folder.string(),
               error.message());
  return report;
}

std::string FocusPlanesJson(const CameraPath& stack, const FocusStackOptions& options) {
  std::string planes;
  for (const FrameId plane : ShownPlanes(stack.frame_count(), false)) {
    const double distance_w = stack.Camera(plane).focus_distance_w;
    const bool is_part = FormOfStack(options.output) == FocusStackForm::kExr;
    const std::string name = FramePath("", plane, options.render.folder.format).string();
    planes += fmt::format(
        "{}\n    {{\"frame\": {}, \"{}\": \"{}\", \"focus_distance_w\": {}, "
        "\"focus_distance_mm\": {}}}",
        planes.empty() ? "" : ",", plane.value, is_part ? "part" : "file",
        is_part ? PartName(plane) : name, distance_w, distance_w * stack.unit_m * 1000);
  }
  return fmt::format("{{\n  \"frame\": {},\n  \"unit_m\": {},\n  \"planes\": [{}\n  ]\n}}\n",
                     options.frame.value, stack.unit_m, planes);
}

}  // namespace lf
