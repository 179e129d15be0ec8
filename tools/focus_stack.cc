// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_stack.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/frame_options.h"
#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"
#include "tools/focus_frame.h"
#include "tools/render_arguments.h"
#include "tools/render_densified.h"
#include "tools/render_summary.h"

#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/analysis/focus_stack/focus_stack.h"
#include "lf/core/file.h"
#include "lf/core/geometry.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/import/paths/open_path.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr HelpTexts kHelp = {
    .summary = "Renders pictures of one camera that differ in their focus distance: a focus stack.",
    .usage = R"(  lffocus stack LIGHTFIELD PATH -o OUT [OPTIONS])",
    .examples = R"(  lffocus stack capture/ path.yaml -o stack
  lffocus stack capture/ path.yaml -o stack.exr --planes 30 --near 0.4 --far 2
  lffocus stack capture/ path.yaml --frame 12 -o stack --distances 400mm,500mm,1.2
  lffocus stack capture/ path.yaml -o rack.mp4 --planes 75 --back-and-forth)",
    .details =
        R"(The camera is that of one frame of PATH. Its position, lens and picture stay, and its focus moves. The
stack is rendered as one film: each LF image is read once for all planes that fit into --memory
together. With --mode collect, each picture has the bits of the frame that lfrenderer makes of a path
with this focus distance. If the lens breathes (lens.breathing in PATH), so do the pictures.

OUT is a folder, or a file if its name ends in .exr or .mp4. A folder receives frame_0001.exr ...,
contact_sheet.png and report.json, as of lfrenderer, and planes.json: the focus distance of each
frame. An EXR file has a part for each plane, focus_0001 ..., with the channels and attributes of the
EXR file of a frame; "focus" is the focus distance in metres, "lf:focus_distance_w" in world units. An
mp4 shows one plane after the other.

While a file is made, its frames are in OUT.partial, which is removed at the end. The state of
unfinished frames is in OUT/partial or OUT.partial/partial. On Ctrl-C (SIGINT), SIGTERM and SIGHUP the
program writes the state and ends with exit code 5; --resume continues.)",
};

struct Arguments {
  RenderArguments render;
  FrameArgument frame;
  std::string distances, near, far;
  uint32_t planes = 30;
  std::optional<double> fps;
  bool back_and_forth = false;
};

void AddInput(CLI::App& app, Arguments& a) {
  a.render.light_field.AddTo(app);
  a.render.light_field.AddReduceTo(app);
  OptionGroup input(app, kInputGroup);
  a.frame.AddTo(input);
  a.render.allow_missing.AddTo(app, "the LF images that the largest pass reads");
}

void AddPlanes(CLI::App& app, Arguments& a) {
  OptionGroup planes(app, kPictureGroup);
  auto* count = planes
                    .Add("--planes N", a.planes,
                         "Number of focus planes\n"
                         "They are even in 1 / distance from --near to --far: from one plane to "
                         "the next, blur disks grow by the same number of elements everywhere.")
                    ->check(CLI::Range(uint32_t{1}, static_cast<uint32_t>(kMostFocusPlanes)));
  auto* near = planes
                   .Add("--near DISTANCE", a.near,
                        "Nearest focus distance (found)\n"
                        "In world units, such as 0.4, or in millimetres, such as 400mm. Found: the "
                        "nearest depth of the scene that the light field states; if it states "
                        "none, LF images are compared.")
                   ->check(NotEmpty());
  auto* far = planes
                  .Add("--far DISTANCE", a.far,
                       "Farthest focus distance (found)\n"
                       "As --near.")
                  ->check(NotEmpty());
  planes
      .Add("--distances LIST|FILE", a.distances,
           "Focus distances of the planes, instead of --planes\n"
           "LIST: such as 0.4,0.5,1.2 or 400mm,500mm. FILE: a text file with distances that are "
           "separated by commas, blanks or line breaks; # begins a comment. The planes have the "
           "order of the distances.")
      ->check(NotEmpty())
      ->excludes(count)
      ->excludes(near)
      ->excludes(far);
}

void AddOutput(CLI::App& app, Arguments& a) {
  OptionGroup output(app, kOutputGroup);
  output.Add("-o,--output OUT", a.render.output, "Folder, or file: stack.exr or rack.mp4")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles(".exr .mp4 folder"));
  AddFrameFormat(output, a.render.format);
  a.render.picture.AddTo(output);
  AddFilmFiles(output, a.render.video, a.render.no_contact_sheet);
  output.AddFlag("--keep-plates", a.render.keep_plates,
                 "Also write the ray sums and counts of each frame\n"
                 "They are written into a file beside the frame, such as frame_0001.plate.");
  output
      .Add("--fps RATE", a.fps,
           "Planes per second of a video (as PATH states)\n"
           "Used by -o FILE.mp4 and --video.")
      ->transform(Rate())
      ->check(CLI::Range(1e-3, 1e3));
  output.AddFlag("--back-and-forth", a.back_and_forth,
                 "Let FILE.mp4 also show the planes backwards\n"
                 "The focus then ends where it began, so that the video can be repeated.");
}

void AddRestart(CLI::App& app, Arguments& a) {
  OptionGroup running(app, kRunningGroup);
  CLI::Option* const resume = running.AddFlag(
      "--resume", a.render.resume,
      "Continue the unfinished render of OUT\n"
      "The inputs and the options that change frames must be the same. Finished frames are kept.");
  running
      .AddFlag("--overwrite", a.render.overwrite,
               "Replace OUT, and remove an unfinished render\n"
               "Needed, unless --resume is given, if OUT is a file that exists, or if there is an "
               "unfinished render of OUT.")
      ->excludes(resume);
}

// Checks the options of the output that do not go together. Sets the format of the frames of a
// video.
//   has_format  true if --format is given
Result<void> CheckForm(Arguments* a, bool has_format) {
  const FocusStackForm form = FormOfStack(a->render.output);
  if (form == FocusStackForm::kFolder)
    LF_RETURN_IF_ERROR(CheckFolderName(a->render.output, "stack.exr or rack.mp4"));
  const auto refuse = [a](std::string_view option, std::string_view why) {
    return UsageError(
        fmt::format("{} cannot be used with -o {}, {}", option, a->render.output, why));
  };
  if (form != FocusStackForm::kVideo && a->back_and_forth)
    return refuse("--back-and-forth", "which is no video: give -o FILE.mp4");
  if (form == FocusStackForm::kExr && a->fps)
    return refuse("--fps", "which is no video: give -o FILE.mp4");
  if (form == FocusStackForm::kFolder && a->fps && a->render.video.empty())
    return refuse("--fps", "which has no video: give --video FILE, or -o FILE.mp4");
  if (form == FocusStackForm::kFolder) return {};
  if (!a->render.video.empty())
    return refuse("--video", "which is a file: give a folder, or only -o FILE.mp4");
  if (a->render.keep_plates)
    return refuse("--keep-plates", "because plates are written beside frames: give a folder");
  if (a->render.no_contact_sheet)
    return refuse("--no-contact-sheet", "which has none: leave the option out");
  const std::optional<FrameFormat> format = ParseFrameFormat(a->render.format);
  if (form == FocusStackForm::kExr && !IsExr(*format))
    return refuse("--format " + a->render.format, "which holds exr or exr-float");
  if (form == FocusStackForm::kVideo && has_format)
    return refuse("--format", "which has no frames of their own: leave the option out");
  if (form == FocusStackForm::kVideo) a->render.format = "png";
  return {};
}

Result<std::vector<double>> GivenDistances(const Arguments& a, double unit_m) {
  Result<std::vector<double>> list = ParseFocusDistances(a.distances, "--distances", unit_m);
  std::error_code error;
  if (list || !fs::exists(a.distances, error)) return list;
  constexpr size_t kMostBytes = size_t{1} << 20;
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(a.distances, kMostBytes));
  return ParseFocusDistances(text + "\n", a.distances, unit_m);
}

Result<std::vector<double>> DistancesOf(const Arguments& a, const LightField& light_field,
                                        const RenderCamera& camera, ThreadPool& pool) {
  if (!a.distances.empty()) return GivenDistances(a, camera.unit_m);
  DepthRange range;
  if (a.near.empty() || a.far.empty()) {
    LF_ASSIGN_OR_RETURN(range, FindFocusRange(light_field, camera, pool, ", by --near and --far"));
  }
  if (!a.near.empty()) {
    LF_ASSIGN_OR_RETURN(range.near_w, ParseFocusDistance(a.near, "--near", camera.unit_m));
  }
  if (!a.far.empty()) {
    LF_ASSIGN_OR_RETURN(range.far_w, ParseFocusDistance(a.far, "--far", camera.unit_m));
  }
  if (!(range.near_w < range.far_w))
    return UsageError(fmt::format(
        "the nearest focus distance is {:.6g} and the farthest {:.6g} world units: expected --near "
        "below --far",
        range.near_w, range.far_w));
  return EvenFocusDistances(range, a.planes);
}

// Returns the path of the stack, and sets *frame to the frame of PATH whose camera it has.
Result<CameraPath> OpenStack(const Arguments& a, const LightField& light_field, ThreadPool& pool,
                             FrameId* frame) {
  LF_ASSIGN_OR_RETURN(CameraPath path, a.frame.Open(light_field));
  if (a.fps) path.fps = *a.fps;
  *frame = a.frame.IdIn(path);
  LF_ASSIGN_OR_RETURN(const std::vector<double> distances_w,
                      DistancesOf(a, light_field, path.Camera(*frame), pool));
  LogInfo("focus stack of frame {}: {} plane{} from {:.6g} to {:.6g} world units", frame->value,
          distances_w.size(), distances_w.size() == 1 ? "" : "s", distances_w.front(),
          distances_w.back());
  return FocusStackPath(path, *frame, distances_w);
}

struct Rendered {
  std::optional<Result<RenderReport>> report;  // unset: OUT was complete already
  FocusStackOptions options;
  CameraPath stack;
  MissingImages missing = {};  // LF images that --densify left out
};

Result<Rendered> RenderStack(const Arguments& a, const CommonOptions& common, ThreadPool& pool,
                             RenderSignals* signals,
                             const std::function<void(const RenderProgress&)>& progress) {
  LF_ASSIGN_OR_RETURN(LightField light_field, a.render.light_field.Open());
  FocusStackOptions options;
  options.output = a.render.output;
  LF_ASSIGN_OR_RETURN(CameraPath stack, OpenStack(a, light_field, pool, &options.frame));
  options.back_and_forth = a.back_and_forth;
  LF_ASSIGN_OR_RETURN(options.render, a.render.MakeOptions(common, stack.frames()));
  options.render.signals = signals;
  options.render.folder.inputs = FilesOfPath(a.frame.path);
  options.render.folder.inputs.emplace_back(a.render.light_field.path);
  options.render.folder.output_folder = StackFolder(options.output);
  LF_ASSIGN_OR_RETURN(options.inputs, StackInputs(light_field, stack, options, a.render.densify));
  // The lock outlasts FILE.partial, which is removed when the file is complete.
  std::optional<FileLock> lock;
  if (FormOfStack(options.output) != FocusStackForm::kFolder) {
    LF_RETURN_IF_ERROR(CreateFolder(fs::absolute(options.output).parent_path()));
    LF_ASSIGN_OR_RETURN(lock, LockOutput(options.output));
  }
  LF_ASSIGN_OR_RETURN(const bool is_finished, IsFinishedStack(stack, options));
  if (is_finished) return Rendered{std::nullopt, options, std::move(stack)};
  LF_RETURN_IF_ERROR(CheckFocusStack(light_field, options));
  MissingImages missing;
  if (a.render.densify) {
    Result<DensifiedFilm> densified =
        DensifyForFilm(std::move(light_field), stack, a.render, options.render, common, pool);
    if (!densified) return Rendered{densified.error(), options, stack};
    light_field = std::move(densified->light_field);
    missing = std::move(densified->missing);
  }
  LF_ASSIGN_OR_RETURN(Package package,
                      PackageOfFilm(std::move(light_field), stack, options.render, pool));
  return Rendered{RenderFocusStack(std::move(package), options, pool, progress), options,
                  std::move(stack), std::move(missing)};
}

// Returns the report of the render, if there was one, with the list of the planes.
std::string ReportJson(const Rendered& rendered) {
  nlohmann::ordered_json report;
  if (rendered.report) report = nlohmann::ordered_json::parse(ToJson(**rendered.report));
  report["focus_stack"] =
      nlohmann::ordered_json::parse(FocusPlanesJson(rendered.stack, rendered.options));
  return RecordText(report);
}

Result<void> Run(Arguments* a, const Program& program, bool has_format, int argc, char** argv) {
  const CommonOptions& common = program.common();
  LF_RETURN_IF_ERROR(CheckForm(a, has_format));
  LF_RETURN_IF_ERROR(a->render.allow_missing.Limit());
  a->render.inputs = {a->render.light_field.path, a->frame.path};
  RenderSignals& signals = CatchRenderSignals();
  ThreadPool pool(common.threads);
  ProgressMeter meter(ParseProgressStyle(common.progress),
                      a->render.settings.Word("estimator") == "nearest" ? "rays" : "px");
  LF_ASSIGN_OR_RETURN(const Rendered rendered,
                      RenderStack(*a, common, pool, &signals, [&](const RenderProgress& now) {
                        meter.Update(now.ray_count, now.ray_total,
                                     {{"LF image", now.image_count, now.image_total},
                                      {"plane", now.frame_count, now.frame_total}});
                      }));
  if (!rendered.report) {
    LogInfo("{}: is complete already", a->render.output);
    return common.json ? PrintReport(ReportJson(rendered)) : Result<void>();
  }
  const Result<RenderReport>& report = *rendered.report;
  if (!report) return WithResumeCommand(report.error(), argc, argv);
  SummariseRender(*report, a->render.output, a->render.settings.Word("lens_weights") == "auto");
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(ReportJson(rendered)));
  return OutcomeOf(*report, rendered.options.render.film, a->render.allow_missing,
                   rendered.missing);
}

}  // namespace

int RunFocusStack(int argc, char** argv) {
  Program program("lffocus stack", kHelp);
  Arguments arguments;
  AddInput(program.app(), arguments);
  AddOutput(program.app(), arguments);
  AddPlanes(program.app(), arguments);
  arguments.render.AddRenderingTo(program.app());
  AddRestart(program.app(), arguments);
  program.AddCommonOptions(RenderArguments::Common());
  return program.Run(argc - 1, argv + 1, [&] {
    return Run(&arguments, program, program.app().count("--format") > 0, argc, argv);
  });
}

}  // namespace lf
