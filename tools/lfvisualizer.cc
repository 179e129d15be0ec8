// SPDX-License-Identifier: Apache-2.0
// lfvisualizer LIGHTFIELD PATH: shows what was captured and what a camera path needs of it.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/check_agreement.h"
#include "tools/common/frame_options.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/setting_options.h"
#include "tools/common/validators.h"
#include "tools/visualizer/export_page.h"
#include "tools/visualizer/page_server.h"
#include "tools/visualizer/web_origin.h"

#include "lf/core/log.h"
#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/core/spelling.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/recording_times.h"
#include "lf/render/state/record_fields.h"
#include "lf/view/scene_text.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfvisualizer"),
    .usage = "  lfvisualizer LIGHTFIELD PATH [PACKAGE...] [OPTIONS]",
    .examples =
        R"(  lfvisualizer capture/ path.yaml                   # open the address that it prints
  lfvisualizer capture/ path.yaml --watch frames    # with the frames that lfrenderer writes there
  lfvisualizer capture/ path.yaml --depth depth.exr # with the points of lffocus depth
  lfvisualizer capture/ path.yaml packages/*.lfp --serve 8080
  lfvisualizer capture/ path.yaml --export site     # as files for any web server or disk
  lfvisualizer capture/ path.yaml --text > scene.txt)",
    .details =
        R"(The page is served until Ctrl-C. It can only be opened on this machine, at an address that contains
a secret. To see it on another machine, start lfvisualizer with --serve 8080, and there run
ssh -L 8080:127.0.0.1:8080 HOST, where HOST is the machine that runs lfvisualizer. If the port is
taken there, use another one, as in ssh -L 9000:127.0.0.1:8080 HOST, also in the address. Behind a
reverse proxy the page needs --allow-origin.

--text prints lines of words; positions are in world units:
  lf_camera ID X Y Z              each LF camera; ID counts from 0
  render_camera FRAME X Y Z       each frame of --frames
  collected FRAME ID SHARE        each LF camera that the frame collects from, and the share of the
                                  pixels of its LF image that is read)",
};

struct Arguments {
  lf::LightFieldArgument light_field;
  lf::PageArguments page;
  lf::FrameRangeArguments frames;
  std::string path, watch, export_folder, live_memory = "512M", export_live = "32M";
  std::vector<std::string> allowed_origins;
  int port = 0;
  lf::SettingOptions settings;
  uint64_t export_images = 400;
  bool text = false;
  lf::AllowMissing allow_missing;
};

void AddInput(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  a.light_field.AddReduceTo(app);
  lf::OptionGroup input(app, lf::kInputGroup);
  // Without a path, Run() advises how to make one.
  input.Add("PATH", a.path,
            std::string(lf::kPathHelp) +
                " The page converts all but our own to YAML, which it saves beside PATH.");
  input.Add("PACKAGE", a.page.packages, "Packages that lfpreprocessor made for this path");
  input
      .Add(
          "--depth FILE", a.page.depths,
          "Show the depths of a scene; may be repeated\n"
          "A depth map (.exr) or a point cloud (.ply) of this light field, as lffocus depth writes "
          "it. The page draws its points in space. If a file has more than 500000 points, one of "
          "each k in a row is drawn, chosen at random.")
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".exr .ply"));
}

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  auto* serve = output.Add("--serve PORT", a.port, "Port of the page (any that is free)")
                    ->check(CLI::Range(0, 65535));
  auto* allow_origin = output.Add(
      "--allow-origin URL", a.allowed_origins,
      "Let a reverse proxy at URL show the page; may be repeated\n"
      "URL is the scheme, the host and, if the browser shows one, the port, such as "
      "https://fields.example. Through forwarded ports of this machine (ssh -L) the page opens "
      "without it.");
  auto* watch =
      output.Add("--watch DIR", a.watch, "Show the frames that lfrenderer writes into DIR")
          ->check(lf::NotEmpty());
  auto* text =
      output.AddFlag("--text", a.text, "Print cameras, and which LF cameras each frame uses")
          ->excludes(serve)
          ->excludes(allow_origin)
          ->excludes(watch);
  for (CLI::Option* const option : a.frames.AddTo(output, "print", "only LF cameras are printed"))
    option->needs(text);
  auto* to_files = output
                       .Add("--export DIR", a.export_folder,
                            "Write the page and its data into a new folder\n"
                            "The program then ends, and serves no page.")
                       ->excludes(text)
                       ->excludes(serve)
                       ->excludes(allow_origin)
                       ->excludes(watch)
                       ->check(lf::NotEmpty());
  output
      .Add("--export-images N", a.export_images,
           "Maximum number of LF images in the export\n"
           "They are chosen from the LF images that the frames of PATH use.")
      ->needs(to_files);
  output
      .Add("--export-live SIZE", a.export_live,
           "Total size of LF images for live pictures\n"
           "Such as 32M; 0: none. The exported page renders live pictures from these LF images by "
           "WebGL2. They are shrunken, and then some are left out, until they fit into SIZE.")
      ->needs(to_files);
  a.allow_missing.AddTo(app, "the LF images in the export")->needs(to_files);
  output
      .Add("--live-memory SIZE", a.live_memory,
           "Memory of the live picture, such as 512M or 4G\n"
           "It bounds the LF images that are kept for pictures that follow the mouse, shrunken to "
           "the "
           "size of the picture.")
      ->excludes(text)
      ->excludes(to_files);
}

void AddQuality(CLI::App& app, Arguments& a) {
  lf::OptionGroup picture(app, lf::kPictureGroup), quality(app, lf::kQualityGroup);
  a.settings.AddTo(picture, "estimator",
                   "Estimator of the render\n"
                   "Give the value that lfrenderer --estimator will have. Which pixels the page "
                   "shows as used depends on it.");
  a.settings.AddTo(picture, "lens_weights",
                   "Lens weights of the render\n"
                   "Give the value that lfrenderer --lens-weights will have. Which LF cameras the "
                   "page shows as used depends on it.");
  a.settings.AddTo(quality, "max_images",
                   "Maximum number of LF images per frame (all)\n"
                   "A frame uses the first N of the LF images that contribute to it, in a random "
                   "order, as with lfrenderer --max-images.");
  a.settings.AddTo(quality, "max_angle_deg",
                   "Largest angle between LF camera and frame axes (no limit)\n"
                   "A frame uses only LF cameras whose optical axis is within DEGREES of its own "
                   "optical axis, as with lfrenderer --max-angle.");
}

void AddOptions(CLI::App& app, Arguments& a) {
  AddInput(app, a);
  AddOutput(app, a);
  AddQuality(app, a);
}

lf::Result<lf::FilmSettings> FilmOf(const Arguments& a, const lf::CommonOptions& common) {
  lf::FilmSettings film;
  LF_RETURN_IF_ERROR(a.settings.Set(&film));
  film.seed = common.seed;
  return film;
}

lf::NeedsOptions Needs(const lf::FilmSettings& film, const lf::LightField& light_field) {
  lf::NeedsOptions needs;
  needs.select.reach = lf::WidestReachOf(film.reading.estimator, light_field.encoding);
  needs.select.max_angle_rad = film.max_angle_rad;
  needs.lens_weights = film.lens_weights;
  needs.max_image_count = film.max_image_count;
  return needs;
}

lf::Result<void> PrintText(const Arguments& a, const lf::CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(lf::CameraPath path,
                      lf::OpenPath(a.path, lf::PathOptionsToRender(light_field)));
  LF_RETURN_IF_ERROR(lf::FitToOpenTimes(light_field, &path));
  LF_ASSIGN_OR_RETURN(std::vector<lf::FrameId> frames, a.frames.Of(path.frames()));
  if (a.frames.IsNone(frames)) a.frames.TellNone();
  if (a.frames.range.empty()) frames = path.frames().All();
  lf::ThreadPool pool(common.threads);
  LF_RETURN_IF_ERROR(lf::AddFocalSurfaces(a.path, light_field, {frames, &pool, nullptr}, &path));
  return lf::WriteSceneText(light_field, path, frames,
                            lf::RanksOf(a.page.film.order, light_field, common.seed),
                            Needs(a.page.film, light_field), pool, lf::PrintReport);
}

// Warns on stderr and on the page if images and poses do not belong together. Runs while the page
// is already open, because it reads dozens of LF images. Errors are those of LF images, which the
// page shows.
void WarnOfDisagreement(const Arguments& a, const std::atomic<bool>& interrupted,
                        lf::PageScene* scene) {
  lf::ThreadPool pool(1);
  const lf::Result<lf::Disagreement> found =
      lf::FindDisagreement(scene->light_field(), a.light_field, pool, &interrupted);
  if (!found || found->text.empty()) return;
  const std::string warning = lf::Spelled(fmt::format("{}. {}", found->text, found->advice));
  lf::LogWarning("{}", warning);
  scene->events().Post("poses", lf::RecordLine({{"warning", warning}}));
}

lf::Result<std::vector<lf::WebOrigin>> AllowedOrigins(const Arguments& a) {
  std::vector<lf::WebOrigin> origins;
  for (const std::string& text : a.allowed_origins) {
    const auto origin =
        lf::ParseWebOrigin(text.ends_with('/') ? text.substr(0, text.size() - 1) : text);
    if (!origin)
      return lf::UsageError(fmt::format(
          "--allow-origin {}: expected http:// or https://, a host and perhaps a port, such as "
          "https://fields.example or http://10.0.0.7:8080; leave out folders, user names and *, "
          "and write names in other scripts as the browser sends them (xn--...)",
          text));
    origins.push_back(*origin);
  }
  return origins;
}

lf::MissingImages MissingOf(const lf::ExportFacts& facts) {
  return {facts.missing_count, facts.image_count,
          fmt::format("{} of {} LF images are not in the export, because they are missing or "
                      "broken; the first: {}",
                      facts.missing_count, facts.image_count, facts.first_missing),
          "once they are mended, export again; both need a new folder for --export"};
}

// Returns the error that no path was given. Returns that of the light field if it cannot be opened,
// because the command that makes a path would then fail.
lf::Error WithoutPath(const Arguments& a) {
  if (const auto light_field = a.light_field.Open(); !light_field) return light_field.error();
  std::vector<std::string> command = {"lfexample", lf::FileArgument(a.light_field.path)};
  lf::LightFieldWords words = a.light_field;
  words.reduce = 1;  // lfexample has no --reduce
  const std::vector<std::string> options = words.Words();
  command.insert(command.end(), options.begin(), options.end());
  command.insert(command.end(), {"-o", lf::FreeName("path", ".yaml")});
  return lf::UsageError(
      fmt::format("PATH is missing: give the camera path of a film after {}. If there is none yet, "
                  "make one to begin with, which the page can change (--move chooses its "
                  "movement): {}",
                  a.light_field.path, lf::ShellCommand(command)));
}

lf::Result<void> Run(Arguments& a, const lf::CommonOptions& common) {
  if (a.path.empty()) return WithoutPath(a);
  if (a.text && !a.page.packages.empty())
    return lf::UsageError(
        "--text cannot be used with packages: leave the packages out, or leave --text out to show "
        "them on the page");
  if (a.text && !a.page.depths.empty())
    return lf::UsageError(
        "--text cannot be used with --depth: leave --depth out, or leave --text out to show the "
        "depths on the page");
  LF_ASSIGN_OR_RETURN(a.page.film, FilmOf(a, common));
  if (a.text) return PrintText(a, common);
  LF_ASSIGN_OR_RETURN(const std::vector<lf::WebOrigin> allowed_origins, AllowedOrigins(a));
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  const std::atomic<bool>& interrupted = lf::CatchInterruptsOfJob();
  std::optional<lf::EndsSoon> until_served(std::in_place);
  a.page.light_field = a.light_field.path;
  a.page.light_field_options = a.light_field.Words();
  a.page.path = a.path;
  a.page.watch = a.watch;
  a.page.threads = common.threads;
  a.page.interrupted = &interrupted;
  LF_ASSIGN_OR_RETURN(a.page.live_memory_bytes, lf::ParseByteSize(a.live_memory, "--live-memory"));
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, a.light_field.Open());
  a.page.needs = Needs(a.page.film, light_field);
  // The page edits the text of the path, and opens it for itself.
  if (const lf::Result<std::vector<double>> times = lf::RecordingTimesOf(a.path);
      times && !times->empty())
    return lf::UsageError(
        fmt::format("{} moves through time (its key time), but the page shows one time: remove the "
                    "key time from the path, and give the time with --time",
                    a.path));
  LF_ASSIGN_OR_RETURN(const auto scene, lf::PageScene::Open(std::move(light_field), a.page));
  if (!a.export_folder.empty()) {
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "steps");
    size_t live_bytes = 0;
    if (a.export_live != "0") {
      LF_ASSIGN_OR_RETURN(live_bytes, lf::ParseByteSize(a.export_live, "--export-live"));
    }
    LF_ASSIGN_OR_RETURN(
        const lf::ExportFacts facts,
        lf::ExportPage(*scene, a.export_folder, a.export_images, live_bytes, interrupted,
                       [&](size_t done, size_t total) { meter.Update(done, total, "exporting"); }));
    LF_RETURN_IF_ERROR(lf::PrintReport(fmt::format(
        "{}: {} files, {}B, {} LF images, {} for live pictures ({}B)\n", a.export_folder,
        facts.file_count, lf::ShortNumber(static_cast<double>(facts.byte_count)),
        facts.image_count - facts.missing_count, facts.live_count,
        lf::ShortNumber(static_cast<double>(facts.live_bytes)))));
    return lf::EndWithMissing(MissingOf(facts), limit);
  }
  LF_ASSIGN_OR_RETURN(const auto server, lf::PageServer::Open(*scene, a.port, allowed_origins));
  LF_RETURN_IF_ERROR(lf::PrintReport(server->address() + "\n"));
  lf::LogInfo("open this address in a browser; Ctrl-C ends lfvisualizer");
  for (const lf::WebOrigin& origin : allowed_origins)
    lf::LogInfo(
        "through the reverse proxy, open {0}/{1}/, or {0}/FOLDER/{1}/ if it forwards FOLDER",
        lf::OriginText(origin), server->token());
  // A server ends as it should, with exit code 0, however long its last answers take.
  until_served.reset();
  const std::jthread check([&] { WarnOfDisagreement(a, interrupted, scene.get()); });
  return server->ServeUntil(interrupted);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfvisualizer", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .seed = "Seed of the order of the LF images",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
