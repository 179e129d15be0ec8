// SPDX-License-Identifier: Apache-2.0
// lfrenderer LIGHTFIELD PATH -o DIR, or PACKAGE... -o DIR: films a light field with a
// thin-lens camera.
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/pinhole_advice.h"
#include "tools/render_arguments.h"
#include "tools/render_densified.h"
#include "tools/render_summary.h"

#include "lf/core/geometry.h"
#include "lf/core/log.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/recording_times.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/pipeline/render_packages.h"
#include "lf/render/state/other_films.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfrenderer"),
    .usage = R"(  lfrenderer LIGHTFIELD PATH -o DIR [OPTIONS]
  lfrenderer PACKAGE... -o DIR [OPTIONS])",
    .examples = R"(  lfrenderer capture/transforms.json path.yaml -o frames
  lfrenderer capture/ path.yaml -o frames --format png16 --video film.mp4
  lfrenderer capture/ path.yaml -o preview --frames 1-100x10 --max-images 200
  lfrenderer capture/ path.yaml -o frames --resume       # after Ctrl-C, kill or a crash
  lfrenderer capture/ path.yaml -o frames --stop-when "noise<=0.002"
  lfrenderer packages/package-*.lfp -o frames            # packages of lfpreprocessor
  lfrenderer capture/ path.yaml -o frames --shard 2/5    # a part of the LF images: see lfmerge
  lfrenderer capture/ path.yaml -o frames --mode hybrid  # interpolate where no ray passes
  lfrenderer capture/ path.yaml -o frames --densify      # smooth blur from few LF images)",
    .details =
        R"(DIR receives frame_0001.exr ..., contact_sheet.png and report.json. EXR frames contain linear light
(R, G, B), the number of rays of each element (count_red, count_green, count_blue; with lens weights
the sum of their weights), and the share of channels with a ray (coverage). With lens weights they
also contain the number of LF images of equal weight that would give the same noise (effective);
with rebinned rays, the share of light that is interpolated (interpolated). With --background none
they also have premultiplied alpha (A); PNG frames have straight alpha. EXR frames state their
camera, lens and primaries as standard attributes of OpenEXR (doc/formats/frame.md).

Each package has its own report, report-package-0000.json, and a package that is rendered alone has
its own contact sheet. Many machines can therefore render packages into one DIR at the same time.

The state of unfinished frames is in DIR/partial. On Ctrl-C (SIGINT), SIGTERM and SIGHUP the program
writes the state and ends with exit code 5. On SIGUSR1 it writes the state and continues. A second
Ctrl-C ends the program at once. A render that is continued with --resume gives frames that are
bit-identical to those of a render without interruption.)",
};

using Progress = std::function<void(const lf::RenderProgress&)>;

// The report of a render, and its options, which were made from the arguments.
struct Rendered {
  lf::Result<lf::RenderReport> report;
  lf::RenderOptions options;
  lf::MissingImages missing = {};  // LF images that --densify left out
};

// Tells that --clamp-frames has left out all frames. Returns an empty report.
Rendered NoFrames(const lf::RenderArguments& arguments, lf::RenderOptions options) {
  arguments.frames.TellNone();
  return {lf::RenderReport(), std::move(options)};
}

lf::Result<Rendered> RenderLightField(const lf::RenderArguments& arguments,
                                      const lf::CommonOptions& common, lf::RenderSignals* signals,
                                      lf::ThreadPool& pool, const Progress& progress) {
  lf::LightFieldArgument argument = arguments.light_field;
  argument.path = arguments.inputs[0];
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, argument.OpenFor(arguments.inputs[1]));
  LF_ASSIGN_OR_RETURN(lf::CameraPath path,
                      lf::OpenPath(arguments.inputs[1], lf::PathOptionsToRender(light_field)));
  LF_RETURN_IF_ERROR(lf::FitToOpenTimes(light_field, &path));
  LF_ASSIGN_OR_RETURN(lf::RenderOptions options, arguments.MakeOptions(common, path.frames()));
  if (arguments.HasNoFrame(options)) return NoFrames(arguments, std::move(options));
  if (!arguments.densify)
    lf::WarnOfPinhole(light_field, path, options.film, arguments.inputs[0], arguments.inputs[1]);
  options.signals = signals;
  // A render compares the surfaces of all frames of earlier renders that it finds.
  const bool has_other_frames =
      options.folder.resume || !lf::ReportsIn(options.folder.output_folder).empty();
  LF_RETURN_IF_ERROR(lf::AddFocalSurfaces(
      arguments.inputs[1], light_field,
      {has_other_frames ? std::vector<lf::FrameId>() : options.frames, &pool, &signals->stop},
      &path));
  options.folder.inputs = lf::FilesOfPath(arguments.inputs[1]);
  options.folder.inputs.emplace_back(arguments.inputs[0]);
  lf::MissingImages missing;
  if (arguments.densify && light_field.slice_times.size() > 1)
    return lf::UsageError(
        "--densify cannot be used with a path that moves through time: render each time as a film "
        "of its own (--time)");
  if (arguments.densify) {
    const lf::EndsSoon until_densified;
    lf::Result<lf::DensifiedFilm> densified =
        lf::DensifyForFilm(std::move(light_field), path, arguments, options, common, pool);
    if (!densified) return Rendered{densified.error(), options};
    light_field = std::move(densified->light_field);
    missing = std::move(densified->missing);
  }
  LF_ASSIGN_OR_RETURN(lf::Package package,
                      lf::PackageOfFilm(std::move(light_field), std::move(path), options, pool));
  return Rendered{lf::Render(std::move(package), options, pool, progress), options, missing};
}

lf::Result<Rendered> RenderPackageFiles(const lf::RenderArguments& arguments,
                                        const lf::CommonOptions& common, lf::RenderSignals* signals,
                                        lf::ThreadPool& pool, const Progress& progress) {
  std::optional<lf::LightFieldPlace> place;
  if (!arguments.light_field.path.empty()) {
    LF_ASSIGN_OR_RETURN(const lf::LightField light_field, arguments.light_field.Open());
    LF_ASSIGN_OR_RETURN(place, lf::PlaceOf(arguments.light_field.path, light_field));
  }
  LF_ASSIGN_OR_RETURN(
      lf::PackagedFilm film,
      lf::OpenPackages({arguments.inputs.begin(), arguments.inputs.end()}, std::move(place)));
  LF_ASSIGN_OR_RETURN(lf::RenderOptions options,
                      arguments.MakeOptions(common, film.first.path.frames()));
  if (arguments.HasNoFrame(options)) return NoFrames(arguments, std::move(options));
  options.signals = signals;
  return Rendered{lf::RenderPackages(std::move(film), options, pool, progress), options};
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfrenderer", kHelp);
  lf::RenderArguments arguments;
  arguments.AddTo(program.app());
  program.AddCommonOptions(lf::RenderArguments::Common());

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    const lf::CommonOptions& common = program.common();
    lf::RenderSignals& signals = lf::CatchRenderSignals();
    LF_RETURN_IF_ERROR(arguments.Check(program.app().count("--seed") > 0));
    lf::ThreadPool pool(common.threads);
    // The progress is counted in pixels of the needed rectangles, because their number is known
    // before the render. With the estimator nearest, each of these pixels is a ray to be tested.
    const char* unit = arguments.settings.Word("estimator") == "nearest" ? "rays" : "px";
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), unit);
    const auto progress = [&](const lf::RenderProgress& now) {
      meter.Update(now.ray_count, now.ray_total,
                   {{"LF image", now.image_count, now.image_total},
                    {"frame", now.frame_count, now.frame_total}});
    };
    const auto render = arguments.HasPackages() ? RenderPackageFiles : RenderLightField;
    LF_ASSIGN_OR_RETURN(const Rendered rendered,
                        render(arguments, common, &signals, pool, progress));
    if (!rendered.report) return lf::WithResumeCommand(rendered.report.error(), argc, argv);
    const lf::RenderReport& report = *rendered.report;
    if (arguments.HasNoFrame(rendered.options))
      return common.json ? lf::PrintReport(lf::ToJson(report)) : lf::Result<void>();
    std::filesystem::path look_at = arguments.output;
    if (rendered.options.film.shard)
      look_at /= "partial/shards/" + rendered.options.film.shard->Name();
    else if (!arguments.no_contact_sheet)
      look_at /= arguments.HasPackages()
                     ? lf::ContactSheetName({arguments.inputs.begin(), arguments.inputs.end()})
                     : "contact_sheet.png";
    lf::SummariseRender(report, look_at.string(),
                        arguments.settings.Word("lens_weights") == "auto");
    if (common.json) LF_RETURN_IF_ERROR(lf::PrintReport(lf::ToJson(report)));
    return lf::OutcomeOf(report, rendered.options.film, arguments.allow_missing, rendered.missing);
  });
}
