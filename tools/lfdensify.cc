// SPDX-License-Identifier: Apache-2.0
// lfdensify LIGHTFIELD [PATH] -o STORE.lfs: puts virtual LF images between recorded ones.
#include <fmt/format.h>

#include <chrono>
#include <string>

#include "tools/common/allow_missing.h"
#include "tools/common/check_agreement.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/store_options.h"
#include "tools/common/validators.h"

#include "lf/core/log.h"
#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/core/version.h"
#include "lf/densify/densify.h"
#include "lf/densify/densify_report.h"
#include "lf/densify/depth_cache.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/recording_times.h"
#include "lf/storage/packed/packed_store_file.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfdensify"),
    .usage = R"(  lfdensify LIGHTFIELD -o STORE.lfs [OPTIONS]
  lfdensify LIGHTFIELD PATH -o STORE.lfs [OPTIONS])",
    .examples = R"(  lfdensify capture/ path.yaml -o film.lfs        # for the lenses of one film
  lfdensify capture/ -o dense.lfs                 # for any camera path
  lfdensify capture/ -o dense.lfs --divisor 2     # photographs with more pixels than frames
  lfrenderer dense.lfs path.yaml -o frames        # a store is a LIGHTFIELD)",
    .details =
        R"(If few photographs are rendered with a large aperture, what is out of focus appears as separate
copies. The program estimates the depth of every pixel by comparing neighbouring LF images, and makes
the images of virtual LF cameras in the lenses of a film, or between the recorded ones if there is no
film. Recorded LF images stay as they are. lfexample --densify chooses a lens that can be filled.
doc/densify.md shows where this works and where it fails.

First, some LF images are left out in turn and made from their neighbours. If the result is hardly
better than a mean of the neighbours, poses or depths are wrong, and the program ends with exit
code 3.

LF images that are missing or broken are left out, and the exit code is then 6.

If LF images that stand at the same places contradict each other, because a reconstruction confused
two sides, a film is made of the side on which its camera stands; a warning names those that are left
out. The program refuses them if that is not clear, or without PATH.

Until the store is complete its name is STORE.lfs.unfinished. Ctrl-C, kill -9 or a crash lose a few
seconds of work; --resume continues.)",
};

struct Arguments {
  lf::LightFieldArgument light_field;
  std::string path, output, memory = "2G", cache;
  std::vector<double> depths;
  lf::DensifyChoices choices;
  bool resume = false, overwrite = false;
  lf::AllowMissing allow_missing;
};

void AddInput(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup);
  input
      .Add("LIGHTFIELD", a.light_field.path,
           "Light field of any supported kind\n"
           "If no PATH is given, its LF cameras must surround an area, and look in one direction, "
           "or "
           "at one point from one side.")
      ->required()
      ->check(lf::NotEmpty());
  input
      .Add("PATH", a.path,
           "Camera path of a film (none)\n"
           "Virtual LF images fill the lenses of its frames, as densely as these need, wherever LF "
           "cameras are near. If it is not given, virtual LF images are made wherever LF cameras "
           "are "
           "around, densely enough for a focus anywhere in the scene.")
      ->check(lf::NotEmpty());
  a.light_field.AddOptionsTo(app);
  a.allow_missing.AddTo(app, "the LF images of the light field");
}

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  lf::AddStoreOutput(output, a.output);
}

void AddQuality(CLI::App& app, Arguments& a) {
  lf::OptionGroup quality(app, lf::kQualityGroup);
  quality
      .Add("--depths NEAR FAR", a.depths,
           "Nearest and farthest depth, in world units (estimated)\n"
           "Distances from the LF cameras, along their optical axes. If the option is not given, "
           "the depths are estimated by comparing a few reduced LF images.")
      ->expected(2)
      ->check(CLI::PositiveNumber);
  quality
      .Add("--spacing PX", a.choices.spacing_px,
           "Largest distance between the copies in a blur (1.5)\n"
           "A point out of focus is shown once by each LF image, and these copies make its blur. "
           "The unit is an element of the frames if PATH is given, for most points that these "
           "show, otherwise a pixel of the virtual LF images.")
      ->check(CLI::Range(0.25, 16.));
  quality
      .Add("--most N", a.choices.most_virtual,
           "Make at most N virtual LF images (2000)\n"
           "If more are needed for --spacing, they stand less densely.")
      ->check(CLI::Range(size_t{1}, size_t{1000000}));
  quality
      .Add("--divisor N", a.choices.divisor,
           "Reduce virtual LF images to 1/N of the size (1)\n"
           "Serves for photographs that have more pixels than frames. Recorded LF images keep "
           "their size.")
      ->check(CLI::Range(1, 16));
  quality.AddFlag("--force", a.choices.force,
                  "Densify even if a check fails\n"
                  "The checks refuse LF images that do not agree with their poses, LF images too "
                  "far from one another, LF cameras that are dense enough already, and LF images "
                  "that cannot be made from their neighbours.");
}

void AddRunning(CLI::App& app, Arguments& a) {
  lf::OptionGroup running(app, lf::kRunningGroup);
  lf::AddStoreRestart(running, a.resume, a.overwrite);
  lf::AddDepthCache(running, a.cache);
  running
      .Add("--memory SIZE", a.memory,
           "Memory for LF images that are kept (2G)\n"
           "On top come 4 bytes of depths for each pixel of all LF images, and for each thread up "
           "to 200 MB and the LF images that it compares: up to nine, of 27 bytes for each pixel. "
           "With --divisor N, a pixel is N x N of those.")
      ->check(lf::NotEmpty());
}

void AddOptions(CLI::App& app, Arguments& a) {
  AddInput(app, a);
  AddOutput(app, a);
  AddQuality(app, a);
  AddRunning(app, a);
}

lf::Result<lf::DensifyOptions> MakeOptions(const Arguments& a, const lf::LightField& light_field) {
  lf::DensifyOptions options;
  options.store = a.output;
  if (options.store.extension() != lf::kStoreExtension)
    return lf::UsageError(
        fmt::format("-o {}: expected a file name that ends in {}", a.output, lf::kStoreExtension));
  options.choices = a.choices;
  if (!a.depths.empty()) {
    if (!(a.depths[0] < a.depths[1]))
      return lf::UsageError(
          fmt::format("--depths {} {}: expected the nearest depth first, then the farthest",
                      a.depths[0], a.depths[1]));
    options.choices.depths = lf::DepthRange{a.depths[0], a.depths[1]};
  }
  if (!a.path.empty()) {
    LF_ASSIGN_OR_RETURN(lf::CameraPath path, lf::OpenPath(a.path, lf::PathOptionsFor(light_field)));
    LF_RETURN_IF_ERROR(lf::FitToOpenTimes(light_field, &path));
    options.choices.frames.assign(path.AllInstants().begin(), path.AllInstants().end());
  }
  LF_ASSIGN_OR_RETURN(options.memory_bytes, lf::ParseByteSize(a.memory, "--memory"));
  LF_ASSIGN_OR_RETURN(options.cache, lf::DepthCacheFolder(a.cache, light_field));
  options.resume = a.resume;
  options.overwrite = a.overwrite;
  options.source_name = a.light_field.path;
  options.source_options = a.light_field.Words();
  options.version = lf::Version();
  return options;
}

// Refuses LF images that do not belong to their poses, because no depth would be right. Only warns
// with --force.
lf::Result<void> CheckAgreement(const Arguments& a, const lf::LightField& light_field,
                                lf::ThreadPool& pool, const std::atomic<bool>& interrupted) {
  LF_ASSIGN_OR_RETURN(const lf::Disagreement found,
                      lf::FindDisagreement(light_field, a.light_field, pool, &interrupted));
  if (found.text.empty()) return {};
  if (!a.choices.force)
    return lf::InputError(
        fmt::format("{}; with --force, densifies nevertheless. {}", found.text, found.advice));
  lf::LogWarning("{}. {}", found.text, found.advice);
  return {};
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  const auto begin = std::chrono::steady_clock::now();
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(lf::DensifyOptions options, MakeOptions(a, light_field));
  options.strict = common.strict;
  options.interrupted = &interrupted;
  lf::ThreadPool pool(common.threads);
  if (!options.resume) LF_RETURN_IF_ERROR(CheckAgreement(a, light_field, pool, interrupted));
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "comparisons");
  LF_ASSIGN_OR_RETURN(
      const lf::DensifyReport report,
      lf::Densify(light_field, options, pool, [&](const lf::DensifyProgress& now) {
        meter.Update(now.work_done, now.work_total, {{now.step, now.done, now.total}});
      }));
  if (!report.dense.empty())
    return lf::InputError(fmt::format(
        "{}; render the light field as it is, or ask for a smaller --spacing", report.dense));
  const double total_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const lf::Result<void> end = lf::EndWithMissing(
      {report.skipped.size(), report.asked_count(), lf::MissingText(report, options),
       "once they are mended, densify again with --overwrite"},
      limit);
  const std::string path = a.path.empty() ? "PATH.yaml" : lf::FileArgument(a.path);
  const std::string next =
      end ? lf::NextRender(lf::ShellCommand({lf::FileArgument(a.output), path})) : "";
  LF_RETURN_IF_ERROR(lf::PrintReport(common.json
                                         ? lf::DensifyJson(report, options, total_s)
                                         : lf::DensifyText(report, options, total_s, next)));
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfdensify", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .strict = "Stop at an LF image that cannot be read\n"
                                      "Without this option it is left out.",
                            .json = "Print the report to stdout as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
