// SPDX-License-Identifier: Apache-2.0
// lfexample LIGHTFIELD -o PATH.yaml: writes a first camera path that is ready to render.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/check_agreement.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"

#include "lf/camera/path/path_yaml.h"
#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/shell_word.h"
#include "lf/densify/densify_trial.h"
#include "lf/focus/example_path.h"
#include "lf/import/paths/write_path.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/storage/load/open_store.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfexample"),
    .usage = "  lfexample LIGHTFIELD -o PATH.yaml [OPTIONS]",
    .examples = R"(  lfexample capture/ -o path.yaml
  lfexample capture/transforms.json -o orbit.yaml --move orbit --camera 364
  lfexample capture/ -o path.yaml --focus 8.12
  lfexample capture/ -o path.yaml --densify     # photographs far apart, and yet a smooth blur)",
    .details =
        R"(The path starts at an LF camera and focuses on the nearest depth that much of its image shows. The
program finds this depth by comparing the image with the images around it; if that fails, from the
points of a COLMAP model. A warning says when the depth is uncertain, and what to try.

If photographs are far apart, a lens shows copies of what is out of focus, and the path has almost a
pinhole. --densify chooses a lens that virtual LF images fill (doc/densify.md), and tests whether
they would be right. Render the path with:
  lfrenderer LIGHTFIELD PATH -o DIR)",
};

// Finds an LF camera by its number, or by the name of its image: the whole name, its last part, or
// the last part without the suffix. "-1" is FirstCamera(). The caller must check that a camera
// of the number exists.
lf::Result<lf::LfImageId> FindCamera(const lf::LightField& light_field,
                                     const lf::LfImageStore& store, const std::string& text) {
  if (text == "-1") return lf::FirstCamera(light_field, store);
  const auto matches = [&](const std::string& name) {
    const std::filesystem::path path(name);
    return name == text || path.filename() == text || path.stem() == text;
  };
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (matches(light_field.image_names[i])) found.push_back(i);
  if (found.size() > 1)
    return lf::UsageError(fmt::format(
        "--camera {}: {} LF images have this name, such as {} and {}: give the image's whole path, "
        "or the number of the camera",
        text, found.size(), light_field.image_names[found[0]], light_field.image_names[found[1]]));
  if (found.size() == 1) return lf::LfImageId{found[0]};
  if (const auto number = lf::ParseWhole<uint32_t>(text)) return lf::LfImageId{*number};
  return lf::UsageError(fmt::format(
      "--camera {}: no LF image has this name: give a name such as {}, or the number of the camera",
      text, light_field.image_names[0]));
}

// Begins the last line of a path, which has the hash of all lines before it.
constexpr std::string_view kStamp = "# Not edited since lfexample wrote it: ";

std::string Stamped(const std::string& yaml) {
  return fmt::format("{}{}{:016x}\n", yaml, kStamp, lf::HashBytes(yaml));
}

bool IsAsWritten(const std::string& text) {
  const size_t stamp = text.rfind(kStamp);
  return stamp != std::string::npos && text == Stamped(text.substr(0, stamp));
}

// Refuses to replace a path that a person has edited. An empty file holds none.
lf::Result<void> CheckKeepsEdits(const std::string& output) {
  std::error_code error;
  if (!std::filesystem::exists(output, error) || std::filesystem::is_empty(output, error))
    return {};
  LF_ASSIGN_OR_RETURN(const std::string before, lf::ReadFile(output));
  if (IsAsWritten(before)) return {};
  return lf::UsageError(fmt::format(
      "{}: exists already, and lfexample has not written it, or it was edited since: give another "
      "name, or replace it with --overwrite",
      output));
}

// Warns that the focus is uncertain: states where it is, why it is uncertain, and how to choose
// another focus.
//   words  the options of the light field, which the shown command repeats
void WarnOfDoubt(const lf::ExamplePath& example, const std::string& light_field,
                 const std::vector<std::string>& words, const std::string& output,
                 const std::string& move, const std::string& camera) {
  std::string distances;
  for (const double distance_w : example.candidates_w)
    distances += fmt::format("{}{:.4g}", distances.empty() ? "" : ", ", distance_w);
  std::vector<std::string> command = {"lfexample", lf::FileArgument(light_field)};
  command.insert(command.end(), words.begin(), words.end());
  command.insert(command.end(), {"-o", lf::FileArgument(output), "--move", move});
  if (camera != "-1") command.insert(command.end(), {"--camera", camera});
  command.insert(command.end(), {"--focus", fmt::format("{:.4g}", example.candidates_w.front())});
  lf::LogWarning(
      "the program is not sure what to focus on ({}). It chose the focus distance {:.4g}, {}, and "
      "the aperture {:.4g}, {} (in world units). The best focus distance{} found: {}. To get a "
      "wider aperture, choose a focus distance: {}",
      example.doubt, example.focus_distance_w, example.focus_reason, example.aperture_diameter_w,
      example.aperture_reason, example.candidates_w.size() == 1 ? "" : "s", distances,
      lf::ShellCommand(command));
}

// Says whether virtual LF images will help a film; if not, the reason. They are tested by leaving
// LF images out.
//   source  LIGHTFIELD and its options, as the user gave them
lf::Result<std::string> WhyNotDensify(const lf::LightField& light_field, const lf::CameraPath& path,
                                      std::span<const std::string> source, lf::ThreadPool& pool) {
  lf::DensifyChoices choices;
  choices.frames.assign(path.AllInstants().begin(), path.AllInstants().end());
  const lf::Result<lf::DensifyTrial> trial = lf::TryDensify(light_field, choices, source, pool);
  if (!trial) {
    if (trial.error().kind != lf::ErrorKind::kInput && trial.error().kind != lf::ErrorKind::kUsage)
      return trial.error();
    return trial.error().message;
  }
  if (!trial->objection.empty()) return trial->objection;
  if (!trial->left_out.empty()) lf::LogWarning("--densify: {}", trial->left_out);
  if (trial->tests.empty())
    lf::LogWarning(
        "it is not sure whether virtual LF images help, because no LF camera stands between "
        "others, so that none can be tested");
  else
    lf::LogInfo(
        "virtual LF images help: {} LF images, left out and made from their neighbours, are {:.1f} "
        "dB better than a mean of these (median; {:.0f} dB)",
        trial->tests.size(), lf::MedianGainDb(trial->tests), lf::MedianPsnrDb(trial->tests));
  return std::string();
}

// Makes a path. If a lens for virtual LF images is asked for and these do not help, warns, and
// makes the path for the recorded ones: options->densify is false then.
lf::Result<lf::ExamplePath> MakePath(const lf::LightField& light_field,
                                     const lf::LfImageStore& store, const std::string& output,
                                     std::span<const std::string> source,
                                     lf::ExampleOptions* options, lf::ThreadPool& pool) {
  LF_ASSIGN_OR_RETURN(lf::ExamplePath example,
                      lf::MakeExamplePath(light_field, store, *options, pool));
  // A path that cannot be parsed is a bug of ours, and is reported here instead of by lfrenderer.
  LF_ASSIGN_OR_RETURN(const lf::CameraPath path,
                      lf::ParsePathYaml(example.yaml, output, light_field.unit_m));
  if (!options->densify || !example.doubt.empty()) return example;
  LF_ASSIGN_OR_RETURN(const std::string why_not, WhyNotDensify(light_field, path, source, pool));
  if (why_not.empty()) return example;
  lf::LogWarning(
      "--densify: virtual LF images do not help, so that the lens is chosen without "
      "them: {}",
      why_not);
  options->densify = false;
  return lf::MakeExamplePath(light_field, store, *options, pool);
}

// Returns the line that advises how to film the path.
std::string NextOf(const lf::LightFieldArgument& input, const std::string& output,
                   lf::ExampleMove move, bool is_densified) {
  std::vector<std::string> options = input.Words();
  if (is_densified) options.emplace_back("--densify");
  if (move != lf::ExampleMove::kStatic)
    options.insert(options.end(), {"--video", lf::FreeName("film", ".mp4")});
  std::string line = lf::NextRender(
      lf::ShellCommand({lf::FileArgument(input.path), lf::FileArgument(output)}), options);
  line.pop_back();  // the end of the line, which LogInfo() adds
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfexample", kHelp);
  lf::LightFieldArgument input;
  std::string output, move = "auto", camera = "-1";
  double focus = 0;
  bool overwrite = false, densify = false;
  CLI::App& app = program.app();
  input.AddTo(app);
  lf::OptionGroup output_group(app, lf::kOutputGroup), picture(app, lf::kPictureGroup);
  output_group.Add("-o,--output PATH.yaml", output, "Camera path to write")->required();
  output_group.AddFlag("--overwrite", overwrite,
                       "Replace PATH.yaml even if it was edited since lfexample\nwrote it");
  picture.Add(
      "--camera NUMBER|NAME", camera,
      "LF camera that the path passes or begins at (near the middle)\n"
      "NUMBER counts from 0; NAME is the name of the camera's image. -1: among the LF cameras that "
      "are level and whose image can be read, the one nearest to the middle of the capture.");
  picture.AddChoice("--move", move, {"auto", "static", "along", "orbit", "dolly", "focus-pull"},
                    "Movement of the camera\n"
                    "auto: along if the LF images are a dense track, such as a hand-held video, "
                    "otherwise focus-pull\n"
                    "static: the camera stands still; the path has one frame\n"
                    "along: the camera moves along the recorded track, without its shaking\n"
                    "orbit: the camera moves once around an ellipse between the LF cameras\n"
                    "dolly: the camera moves straight ahead\n"
                    "focus-pull: the camera stands still, and the focus moves from near to far");
  picture
      .Add("--focus X", focus,
           "Focus distance in world units (automatic)\n"
           "0: the program estimates the distance of the subject from the LF images.")
      ->check(CLI::NonNegativeNumber);
  picture.AddFlag(
      "--densify", densify,
      "Choose a lens for a render with virtual LF images\n"
      "Serves for photographs that are far apart. The program tests whether the virtual "
      "LF images would be right, and chooses the lens without them if not. Render the "
      "path with lfrenderer --densify.");
  program.AddCommonOptions({.threads = true, .verbose = true, .quiet = true});

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    LF_RETURN_IF_ERROR(lf::CheckReplacesPath(output));
    LF_ASSIGN_OR_RETURN(lf::LightField opened, input.Open());
    // Focus and aperture are chosen for what was recorded.
    const lf::LightField light_field = lf::RecordedPart(std::move(opened));
    lf::ExampleOptions options;
    options.move = *lf::ParseExampleMove(move);
    if (focus > 0) options.focus_distance_w = focus;
    options.densify = densify;
    options.points_world = [&] {
      return lf::PointsSeenBy(input.path, light_field, options.camera);
    };
    lf::ThreadPool pool(program.common().threads);
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<lf::LfImageStore> store,
                        lf::OpenStore(light_field, lf::Mosaics::kToRgb));
    LF_ASSIGN_OR_RETURN(const lf::Disagreement disagreement,
                        lf::FindDisagreement(light_field, input, pool));
    if (!disagreement.text.empty()) options.doubt = "images and poses do not agree";
    LF_ASSIGN_OR_RETURN(options.camera, FindCamera(light_field, *store, camera));
    std::vector<std::string> source = input.Words();
    source.insert(source.begin(), lf::FileArgument(input.path));
    LF_ASSIGN_OR_RETURN(const lf::ExamplePath example,
                        MakePath(light_field, *store, output, source, &options, pool));
    if (!overwrite) LF_RETURN_IF_ERROR(CheckKeepsEdits(output));
    LF_RETURN_IF_ERROR(lf::WriteFileAtomically(output, Stamped(example.yaml)));
    if (!disagreement.text.empty())
      lf::LogWarning("{}. {}", disagreement.text, disagreement.advice);
    if (!example.doubt.empty())
      WarnOfDoubt(example, input.path, input.Words(), output, move, camera);
    if (!example.move_warning.empty()) lf::LogWarning("{}", example.move_warning);
    if (!example.move_note.empty()) lf::LogInfo("{}", example.move_note);
    lf::LogInfo("{}: {} LF camera {} ({}), focus at {:.4g} ({}), aperture {:.4g} ({})", output,
                lf::StartWords(example.move), options.camera.value,
                light_field.image_names[options.camera.value], example.focus_distance_w,
                example.focus_reason, example.aperture_diameter_w, example.aperture_reason);
    lf::LogInfo("{}",
                NextOf(input, output, example.move, options.densify && example.doubt.empty()));
    return {};
  });
}
