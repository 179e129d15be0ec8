// SPDX-License-Identifier: Apache-2.0
// lfpreprocessor LIGHTFIELD PATH -o DIR: makes packages to be rendered by many machines.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/frame_options.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/setting_options.h"
#include "tools/common/validators.h"
#include "tools/pinhole_advice.h"

#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/core/version.h"
#include "lf/distribute/preprocess/forecast_report.h"
#include "lf/distribute/preprocess/known_depths.h"
#include "lf/distribute/preprocess/preprocess.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/recording_times.h"
#include "lf/render/settings/interpolation.h"
#include "lf/render/settings/setting_table.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfpreprocessor"),
    .usage = R"(  lfpreprocessor LIGHTFIELD PATH --plan [OPTIONS]
  lfpreprocessor LIGHTFIELD PATH -o DIR [OPTIONS])",
    .examples =
        R"(  lfpreprocessor capture/ path.yaml --plan           # forecast of cost and picture quality
  lfpreprocessor capture/ path.yaml -o packages --packages 4
  lfpreprocessor capture/ path.yaml -o packages --memory 4G
  lfrenderer packages/package-0000.lfp -o frames     # each package on any machine)",
    .details =
        R"(The packages are DIR/package-0000.lfp, ... (doc/formats/package.md). A package contains the render
cameras of a section of the film, and the LF cameras that its frames need, with their pixel
rectangles and their order. With --frames 1-4 the names are package-0000-of-frames-1-4.lfp, ..., so
that packages of several parts of a film fit into one DIR. Frames that are rendered from packages are
bit-identical to those of lfrenderer LIGHTFIELD PATH.)",
};

struct Arguments {
  lf::LightFieldArgument light_field;
  lf::FrameRangeArguments frames;
  std::string path, output, memory = "8G", balance = "rays";
  lf::SettingOptions settings;  // of the later render
  int64_t packages = 0, frames_per_package = 0;
  std::vector<double> depths;
  bool no_guard = false, plan = false, overwrite = false;
  lf::AllowMissing allow_missing;
};

void AddInputAndOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup), output(app, lf::kOutputGroup);
  a.light_field.AddTo(app);
  input.Add("PATH", a.path, lf::kPathHelp)->required();
  a.allow_missing.AddTo(app, "the LF images that packages need");
  auto* plan = output.AddFlag("--plan", a.plan,
                              "Print the forecast of the render, write no packages\n"
                              "The forecast tells the time and memory of the render, and whether "
                              "the capture is dense enough for the camera path.");
  output.Add("-o,--output DIR", a.output, "Folder of the packages")
      ->check(lf::NotEmpty())
      ->excludes(plan);
  output.AddFlag("--overwrite", a.overwrite,
                 "Replace the packages in DIR\n"
                 "All packages in DIR are replaced; with --frames, only those that were made with "
                 "the same --frames.");
  a.frames.AddTo(output, "render", "nothing is selected");
  auto* packages =
      output.Add("--packages N", a.packages, "Number of packages (as few as --memory allows)")
          ->check(CLI::Range(0, 1'000'000));
  output
      .Add("--frames-per-package N", a.frames_per_package,
           "Frames per package (as many as --memory allows)")
      ->check(CLI::Range(0, 1'000'000))
      ->excludes(packages);
  output.AddChoice(
      "--balance", a.balance, {"rays", "frames"},
      "Quantity that is equal in all packages\n"
      "rays: packages have about the same number of rays, and take about the same time to render\n"
      "frames: packages have the same number of frames");
}

void AddRender(CLI::App& app, Arguments& a) {
  lf::OptionGroup picture(app, lf::kPictureGroup);
  a.settings.AddTo(
      picture, "mode",
      "Mode of the later render\n"
      "Give the value that lfrenderer --mode will have. It affects which LF images and pixels the "
      "packages contain, the forecast, and the pixels that lfcompressor --needed-pixels keeps.");
  a.settings.AddTo(
      picture, "interpolation",
      "Interpolation of the later render\n"
      "Give the value that lfrenderer --interpolation will have, or cells if the later render will "
      "have an option that only cells use. It matters with --mode rebin and hybrid: the checks of "
      "lenses and options, and the pixels that lfcompressor --needed-pixels keeps, depend on it.");
  a.settings.AddTo(
      picture, "lens_weights",
      "Lens weights of the later render\n"
      "Give the value that lfrenderer --lens-weights will have.\n"
      "none, with --mode collect: packages do not contain the LF cameras beside the lens, and can "
      "only be rendered with --lens-weights none");
  picture.AddFlag("--no-guard", a.no_guard,
                  "The later render will have --no-guard\n"
                  "It matters only for densified light fields.");
  a.settings.AddTo(
      picture, "estimator",
      "Estimator of the later render\n"
      "Give the value that lfrenderer --estimator will have. The forecast and the pixels that "
      "lfcompressor --needed-pixels keeps depend on it.");
}

void AddQuality(CLI::App& app, Arguments& a) {
  lf::OptionGroup quality(app, lf::kQualityGroup), running(app, lf::kRunningGroup);
  a.settings.AddTo(quality, "max_images",
                   "Maximum number of LF images per frame (all)\n"
                   "A frame uses the first N of the LF images that contribute to it, in the order "
                   "of --order.");
  a.settings.AddTo(quality, "max_angle_deg");
  a.settings.AddTo(quality, "order",
                   "Order in which frames take LF images\n"
                   "spread: LF images whose positions are spread evenly over the lens, however "
                   "many are taken; by --seed\n"
                   "shuffle: random, by --seed\n"
                   "round-robin: always an LF image for the frame with the fewest rays\n"
                   "area: LF images with the most rays first\n"
                   "groups: groups of neighbours one after another, by --seed; predicted LF "
                   "images of packed stores are then decoded with little memory");
  quality
      .Add("--depths NEAR FAR", a.depths,
           "Nearest and farthest depth of the scene, for the forecast\n"
           "Distances from the LF cameras, in world units. The forecast tells whether the LF "
           "cameras are close enough to each other for these depths. If the option is not given, "
           "the depths are taken from the calibration, or, if it has none, estimated from LF "
           "images.")
      ->expected(2)
      ->check(CLI::Range(1e-9, 1e12));
  running.Add("--memory SIZE", a.memory,
              "Memory that the render of a package may use\n"
              "Unless --packages or --frames-per-package is given, the program makes as few "
              "packages as possible, each with plates that fit into SIZE. "
              "The forecast assumes that lfrenderer has the same --memory.");
}

void AddOptions(CLI::App& app, Arguments& a) {
  AddInputAndOutput(app, a);
  AddRender(app, a);
  AddQuality(app, a);
}

lf::Result<lf::PreprocessOptions> MakeOptions(const Arguments& a, const lf::CommonOptions& common,
                                              const lf::CameraPath& path) {
  lf::PreprocessOptions options;
  if (!a.plan) {
    if (a.output.empty())
      return lf::UsageError(
          "-o DIR is missing: give the folder of the packages, or --plan for the forecast alone");
    options.output_folder = a.output;
  }
  options.overwrite = a.overwrite;
  options.inputs = lf::FilesOfPath(a.path);
  options.inputs.emplace_back(a.light_field.path);
  LF_ASSIGN_OR_RETURN(options.frames, a.frames.Of(path.frames()));
  LF_RETURN_IF_ERROR(a.settings.Set(&options.film));
  options.film.seed = common.seed;
  options.film.guard = !a.no_guard;
  LF_ASSIGN_OR_RETURN(options.memory_bytes, lf::ParseByteSize(a.memory, "--memory"));
  if (a.packages > 0) options.package_count = static_cast<size_t>(a.packages);
  if (a.frames_per_package > 0)
    options.frames_per_package = static_cast<size_t>(a.frames_per_package);
  options.balance = a.balance == "frames" ? lf::PackageBalance::kFrames : lf::PackageBalance::kRays;
  if (!a.depths.empty()) {
    if (!(a.depths[0] < a.depths[1]))
      return lf::UsageError(
          fmt::format("--depths {} {}: expected a near depth that is less than the far depth",
                      a.depths[0], a.depths[1]));
    options.depths = lf::DepthRange{a.depths[0], a.depths[1]};
  }
  options.strict = common.strict;
  options.version = lf::Version();
  options.light_field_name = a.light_field.path;
  options.light_field_options = a.light_field.WordsToKeep();
  return options;
}

// Tells that --clamp-frames has left out all frames, and prints a report without packages.
lf::Result<void> ReportNoFrames(const Arguments& a, const lf::CommonOptions& common,
                                const lf::LightField& light_field, const lf::CameraPath& path) {
  a.frames.TellNone();
  if (!common.json) return {};
  lf::PreprocessReport report;
  report.light_field_image_count = light_field.size();
  lf::ForecastFacts facts;
  facts.light_field = a.light_field.path;
  facts.output = a.output;
  return lf::PrintReport(lf::ForecastJson(report, path, facts));
}

// Returns the line that advises how to render the packages, with those options of this call that
// lfrenderer must be given again.
std::string NextOf(const Arguments& a, const lf::PreprocessReport& report) {
  std::vector<std::string> packages, options;
  for (const lf::PackageForecast& package : report.packages)
    packages.push_back((std::filesystem::path(a.output) / (package.name + ".lfp")).string());
  const auto repeat = [&](const std::string& option, const std::string& value,
                          const std::string& otherwise) {
    if (value != otherwise) options.insert(options.end(), {option, value});
  };
  for (const char* key : {"mode", "interpolation", "lens_weights", "estimator"})
    repeat(lf::CommandLineOption({key}), a.settings.Word(key),
           lf::FindSetting(key)->get(lf::FilmSettings()));
  const Arguments usual;
  repeat("--memory", a.memory, usual.memory);
  repeat("--allow-missing", a.allow_missing.text, usual.allow_missing.text);
  if (a.no_guard) options.emplace_back("--no-guard");
  return lf::NextRender(lf::ShellPackages(packages), options);
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  const auto start = std::chrono::steady_clock::now();
  LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.OpenFor(a.path));
  const double read_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  LF_ASSIGN_OR_RETURN(lf::CameraPath path,
                      lf::OpenPath(a.path, lf::PathOptionsToRender(light_field)));
  LF_RETURN_IF_ERROR(lf::FitToOpenTimes(light_field, &path));
  if (!a.output.empty() && light_field.slice_times.size() > 1)
    return lf::UsageError(
        "packages cannot hold a path that moves through time: render it by lfrenderer with "
        "--shard, or package each time as a film of its own (--time)");
  LF_ASSIGN_OR_RETURN(lf::PreprocessOptions options, MakeOptions(a, common, path));
  if (light_field.video && light_field.video->is_of_path) {
    // Programs that get the packages open the light field again, without the path.
    lf::LightFieldWords words = a.light_field;
    words.time = light_field.slice_times[0];
    options.light_field_options = words.WordsToKeep();
  }
  if (a.frames.IsNone(options.frames)) return ReportNoFrames(a, common, light_field, path);
  lf::WarnOfPinhole(light_field, path, options.film, a.light_field.path, a.path);
  options.interrupted = &interrupted;
  lf::ThreadPool pool(common.threads);
  // Packages hold the cameras of the whole path.
  LF_RETURN_IF_ERROR(lf::AddFocalSurfaces(a.path, light_field, {{}, &pool, &interrupted}, &path));
  const lf::DepthSource depths_from = lf::KnowDepths(light_field, path, pool, &options);
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "frames");
  LF_ASSIGN_OR_RETURN(
      const lf::PreprocessReport report,
      lf::Preprocess(light_field, path, options, pool, [&](size_t done, size_t total) {
        meter.Update(done, total, 2 * done <= total ? "selecting" : "packing");
      }));
  lf::ForecastFacts facts;
  facts.light_field = a.light_field.path;
  facts.output = a.output;
  facts.order = options.film.order;
  facts.seed = options.film.seed;
  facts.thread_count = pool.thread_count();
  facts.read_s = read_s;
  facts.rebins = lf::KeepsCells(options.film);
  facts.completes = options.film.mode == lf::RenderMode::kHybrid;
  facts.depths_from = depths_from;
  facts.depths_argument = "--depths";
  const lf::Result<void> end = lf::EndWithMissing(
      {report.missing_count, report.needed_count, lf::MissingText(report),
       "renders of these packages leave them out, unless they are mended before"},
      limit);
  if (end && !a.output.empty()) facts.next = NextOf(a, report);
  LF_RETURN_IF_ERROR(lf::PrintReport(common.json ? lf::ForecastJson(report, path, facts)
                                                 : lf::ForecastText(report, path, facts)));
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfpreprocessor", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .seed = "Seed of the order of the LF images",
                            .strict = "Stop if an image file that packages need is missing\n"
                                      "Without this option, packages are made nevertheless.",
                            .json = "Print the report to stdout as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
