// lfrenderer LIGHTFIELD PATH.yaml -o DIR: films a light field with a thin-lens camera.
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include "tools/common/byte_size.h"
#include "tools/common/duration.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/render_summary.h"

#include "lf/core/log.h"
#include "lf/path/path_yaml.h"
#include "lf/pipeline/frame_range.h"
#include "lf/pipeline/render.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfrenderer capture/transforms.json path.yaml -o frames
  lfrenderer capture/ path.yaml -o frames --format png16 --video film.mp4
  lfrenderer capture/ path.yaml -o preview --frames 1-100x10 --max-images 200
  lfrenderer capture/ path.yaml -o frames --resume       # after Ctrl-C, kill, a crash
  lfrenderer capture/ path.yaml -o frames --stop-when "samples>=16"

DIR receives frame_0001.exr ..., contact_sheet.png and report.json. EXR frames hold linear light
(R, G, B), the rays of every element (count.R, count.G, count.B; with lens weights the sums of their
weights), coverage, and with lens weights how many LF images of equal weight there are (effective).

The state of unfinished frames lies in DIR/partial. Ctrl-C (SIGINT), SIGTERM and SIGHUP write it and end
with exit code 5, SIGUSR1 writes it and goes on; a second Ctrl-C ends at once. --resume gives the same
bits as if there had been no interruption.)";

struct Arguments {
  lf::LightFieldArgument light_field;
  std::string path, output, video, frames, memory = "8G", format = "exr", mode = "collect";
  std::string estimator = "auto", filter = "auto", lens_weights = "auto", back_end = "fast";
  std::string dump_every = "30s", stop_when, require;
  int64_t max_images = 0;
  uint32_t smooth_below = 0;
  bool no_contact_sheet = false, resume = false, overwrite = false, keep_plates = false;
};

// Words of the full contract that this version cannot honour are refused, never ignored.
lf::Result<void> CheckAvailable(const std::string& option, const std::string& value,
                                std::initializer_list<const char*> available) {
  for (const char* word : available)
    if (value == word) return {};
  return lf::UsageError(
      fmt::format("{} {} is not available in version {}", option, value, lf::Version()));
}

lf::Result<lf::RenderOptions> MakeOptions(const Arguments& arguments, const lf::Program& program,
                                          const lf::LightField& light_field,
                                          const lf::CameraPath& path) {
  lf::RenderOptions options;
  options.output_folder = arguments.output;
  if (!arguments.frames.empty()) {
    LF_ASSIGN_OR_RETURN(options.frames, lf::ParseFrameRange(arguments.frames, path.frame_count()));
  }
  options.format = *lf::ParseFrameFormat(arguments.format);
  if (!arguments.video.empty()) options.video = arguments.video;
  options.contact_sheet = !arguments.no_contact_sheet;
  if (arguments.max_images > 0) options.max_image_count = static_cast<size_t>(arguments.max_images);
  options.smooth_below = arguments.smooth_below;
  LF_ASSIGN_OR_RETURN(options.memory_bytes, lf::ParseByteSize(arguments.memory, "--memory"));
  options.seed = program.common().seed;
  options.strict = program.common().strict;
  options.reading.estimator =
      arguments.estimator == "nearest" ? lf::Estimator::kNearest : lf::Estimator::kBilinear;
  for (const lf::PixelFilter filter : {lf::PixelFilter::kNearest, lf::PixelFilter::kBilinear,
                                       lf::PixelFilter::kBicubic, lf::PixelFilter::kMosaic})
    if (arguments.filter == lf::NameOf(filter)) options.reading.filter = filter;
  for (const lf::LensWeights weights :
       {lf::LensWeights::kAuto, lf::LensWeights::kArea, lf::LensWeights::kHat})
    if (arguments.lens_weights == lf::NameOf(weights)) options.lens_weights = weights;
  if (arguments.back_end == "reference") options.back_end = lf::CollectBackEnd::kReference;
  options.version = lf::Version();
  LF_ASSIGN_OR_RETURN(options.dump_every_s,
                      lf::ParseDuration(arguments.dump_every, "--dump-every"));
  if (!arguments.stop_when.empty()) {
    LF_ASSIGN_OR_RETURN(options.stop_at_samples,
                        lf::ParseSampleRule(arguments.stop_when, "--stop-when"));
  }
  if (!arguments.require.empty()) {
    LF_ASSIGN_OR_RETURN(options.require_samples,
                        lf::ParseSampleRule(arguments.require, "--require"));
  }
  if (options.lens_weights == lf::LensWeights::kAuto && options.CountsRays()) {
    options.lens_weights = lf::LensWeights::kNone;
    lf::LogInfo(
        "--lens-weights auto: none, since --stop-when, --require and --smooth-below count rays");
  }
  if (options.reading.filter == lf::PixelFilter::kAuto && !options.CountsRays() &&
      light_field.encoding.bayer != lf::BayerPattern::kNone)
    options.reading.filter = lf::PixelFilter::kMosaic;
  options.resume = arguments.resume;
  options.overwrite = arguments.overwrite;
  options.keep_plates = arguments.keep_plates;
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfrenderer",
                      "Films a densely recorded light field with a thin-lens camera on a path.",
                      kExamples);
  Arguments arguments;
  CLI::App& app = program.app();
  arguments.light_field.AddTo(app);
  app.add_option("PATH.yaml", arguments.path, "Camera path (doc/formats/path.md)")->required();
  app.add_option("-o,--output", arguments.output, "Folder of the frames")->required();
  app.add_option("--frames", arguments.frames, "Frames to render: 1-100x2, 7, 3-5,9")
      ->check(lf::NotEmpty());
  app.add_option("--format", arguments.format, "exr, exr-float, png or png16")
      ->check(CLI::IsMember({"exr", "exr-float", "png", "png16"}));
  app.add_option("--video", arguments.video, "Also write the frames as this mp4 (needs ffmpeg)")
      ->check(lf::NotEmpty());
  app.add_flag("--no-contact-sheet", arguments.no_contact_sheet, "No contact_sheet.png");
  app.add_option("--memory", arguments.memory, "Bound of the memory used");
  app.add_option("--max-images", arguments.max_images,
                 "Use only so many LF images for each frame, the first of a shuffled order; 0: all")
      ->check(lf::WholeNumber());
  app.add_option(
      "--dump-every", arguments.dump_every,
      "Write the state so often, such as 30s, 10m, 1h; seldomer if it would take more than "
      "5 % of the time; 0: at signals only");
  auto* resume = app.add_flag("--resume", arguments.resume,
                              "Go on with the render in DIR, from the same inputs; finished frames "
                              "are kept");
  app.add_flag("--overwrite", arguments.overwrite, "Remove an unfinished render in DIR")
      ->excludes(resume);
  app.add_option(
         "--stop-when", arguments.stop_when,
         "samples>=N: a frame is finished when 99 % of the elements that LF images see have "
         "N rays in every channel")
      ->check(lf::NotEmpty());
  app.add_option("--require", arguments.require,
                 "samples>=N: exit code 6 if a frame has fewer in the end")
      ->check(lf::NotEmpty());
  app.add_flag("--keep-plates", arguments.keep_plates,
               "Also write each frame's sums and counts: frame_0001.plate");
  app.add_option("--smooth-below", arguments.smooth_below,
                 "Smooth elements with fewer rays than this; empty ones are always filled");
  app.add_option("--mode", arguments.mode, "collect")
      ->check(CLI::IsMember({"collect", "rebin", "hybrid"}));
  app.add_option(
         "--estimator", arguments.estimator,
         "bilinear (auto): every element reads each LF image where it looks; nearest: every "
         "LF pixel goes to one element, and mosaics are not interpolated")
      ->check(CLI::IsMember({"auto", "nearest", "bilinear"}));
  app.add_option(
         "--filter", arguments.filter,
         "Of the estimator bilinear, between LF pixels: nearest, bilinear, bicubic; auto: "
         "bicubic, but bilinear where an element is as large as nine LF pixels or more; "
         "mosaic (auto for mosaics): the same, and colours that the sensor recorded count 8 times "
         "those that were interpolated")
      ->check(CLI::IsMember({"auto", "nearest", "bilinear", "bicubic", "mosaic"}));
  app.add_option(
         "--lens-weights", arguments.lens_weights,
         "none: LF images count alike; area: as the part of the lens that is nearest to each; hat: "
         "interpolated, for small lenses and pinholes; auto: area, and hat as the lens closes")
      ->check(CLI::IsMember({"auto", "none", "area", "hat"}));
  app.add_option("--back-end", arguments.back_end,
                 "fast, or reference: the literal formulas, one ray at a time")
      ->check(CLI::IsMember({"fast", "reference"}));
  program.AddJsonOption("Print the report to stdout");

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    lf::RenderSignals& signals = lf::CatchRenderSignals();
    LF_RETURN_IF_ERROR(CheckAvailable("--mode", arguments.mode, {"collect"}));
    LF_RETURN_IF_ERROR(
        CheckAvailable("--estimator", arguments.estimator, {"auto", "nearest", "bilinear"}));
    LF_ASSIGN_OR_RETURN(lf::LightField light_field, arguments.light_field.Open());
    LF_ASSIGN_OR_RETURN(const lf::CameraPath path,
                        lf::ReadPathYaml(arguments.path, light_field.unit_m));
    LF_ASSIGN_OR_RETURN(lf::RenderOptions options,
                        MakeOptions(arguments, program, light_field, path));
    options.signals = &signals;
    if (options.reading.estimator == lf::Estimator::kBilinear)
      lf::MakeRoomForUndershoot(&light_field.encoding);
    lf::ThreadPool pool(program.common().threads);
    // What is known beforehand: every pixel of a needed rectangle is tried as a ray, or read.
    const char* unit = options.reading.estimator == lf::Estimator::kNearest ? "rays" : "px";
    lf::ProgressMeter meter(lf::ParseProgressStyle(program.common().progress), unit);
    const auto progress = [&](const lf::RenderProgress& now) {
      meter.Update(now.ray_count, now.ray_total,
                   fmt::format("LF image {}/{}, frame {}/{}", now.image_count, now.image_total,
                               now.frame_count, now.frame_total));
    };
    const lf::Result<lf::RenderReport> rendered =
        lf::Render(light_field, path, options, pool, progress);
    if (!rendered) return lf::WithResumeCommand(rendered.error(), argc, argv);
    const lf::RenderReport& report = *rendered;
    lf::SummariseRender(report, arguments.no_contact_sheet
                                    ? arguments.output
                                    : arguments.output + "/contact_sheet.png");
    if (program.common().json && !(std::cout << lf::ToJson(report) << std::flush))
      return lf::OutputError("--json: the report cannot be written to stdout");
    return lf::CheckRequired(report, options.require_samples);
  });
}
