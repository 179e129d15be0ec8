#include "tools/render_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/common/byte_size.h"
#include "tools/common/duration.h"

#include "lf/collector/noise_rule.h"
#include "lf/core/log.h"
#include "lf/package/package_file.h"
#include "lf/pipeline/frame_range.h"
#include "lf/sequence/develop.h"

namespace lf {
namespace {

// Parses the value of --fill.
Result<int> ParseFill(const std::string& text) {
  if (text == "off") return 0;
  int radius_px = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), radius_px);
  if (error == std::errc() && end == text.data() + text.size() && radius_px >= 0 &&
      radius_px <= kMostFillRadius_px)
    return radius_px;
  return UsageError(fmt::format("--fill {}: expected a number of elements from 0 to {}, or off",
                                text, kMostFillRadius_px));
}

}  // namespace

void RenderArguments::AddTo(CLI::App& app) {
  app.add_option(
         "INPUT", inputs,
         "LIGHTFIELD PATH.yaml: a calibration file or its folder (transforms.json, COLMAP, "
         "Middlebury, LLFF, AOS, a packed store; or images with Stanford names) and a camera path "
         "(doc/formats/path.md); or PACKAGE...: files of lfpreprocessor")
      ->required();
  app.add_option(
         "--lightfield", light_field.path,
         "Where the light field of the packages is now, if it has moved; or a packed store of "
         "their LF images")
      ->check(NotEmpty());
  light_field.AddOptionsTo(app);
  app.add_option("-o,--output", output, "Folder of the frames")->required();
  app.add_option("--frames", frames, "Frames to render: 1-100x2, 7, 3-5,9")->check(NotEmpty());
  app.add_option("--format", format, "exr, exr-float, png or png16")
      ->check(CLI::IsMember({"exr", "exr-float", "png", "png16"}));
  app.add_option("--video", video, "Also write the frames as this mp4 (needs ffmpeg)")
      ->check(NotEmpty());
  app.add_flag("--no-contact-sheet", no_contact_sheet, "No contact_sheet.png");
  app.add_option("--memory", memory, "Bound of the memory used");
  app.add_option("--max-images", max_images,
                 "Use only so many LF images for each frame, the first of a shuffled order; 0: all")
      ->check(WholeNumber());
  app.add_option("--max-angle", max_angle_deg,
                 "Only LF cameras whose optical axes differ by at most so many degrees from the "
                 "frame's; 0: all")
      ->check(CLI::Range(0., 180.));
  app.add_option("--order", order,
                 "Order of the LF images, which matters where --max-images or --stop-when end a "
                 "frame early: shuffle, by --seed; round-robin, so that all frames fill equally; "
                 "area, most rays first")
      ->check(CLI::IsMember({"shuffle", "round-robin", "area"}));
  app.add_option(
      "--dump-every", dump_every,
      "Write the state so often, such as 30s, 10m, 1h; seldomer if it would take more than "
      "5 % of the time; 0: at signals only");
  auto* resume_flag =
      app.add_flag("--resume", resume,
                   "Go on with the render in DIR, from the same inputs; finished frames "
                   "are kept");
  app.add_flag("--overwrite", overwrite, "Remove an unfinished render in DIR")
      ->excludes(resume_flag);
  app.add_option("--finish", finish,
                 "With --resume: finish these frames (1-10,20) with the rays that they have; the "
                 "others go on, and the report says which LF images these are")
      ->check(NotEmpty());
  app.add_option(
         "--stop-when", stop_when,
         "Finish a frame when it is good enough. noise<=X: when the noise of 90 % of the elements "
         "that LF images see is at most X, the standard error of their mean in linear light with "
         "white as 1 (0.002 is half a level of 255 in a mid-grey); with every mode and all lens "
         "weights; "
         "rebin measures it by a plate of 24 bytes for each element of every frame. samples>=N: "
         "when 99 % of them have N rays in every channel; lens weights are then none")
      ->check(NotEmpty());
  app.add_option("--require", require,
                 "noise<=X or samples>=N: exit code 6 if a frame has more noise or fewer rays in "
                 "the end")
      ->check(NotEmpty());
  allow_missing.AddTo(app, "those that the largest pass reads, of packages in each by itself");
  app.add_flag("--keep-plates", keep_plates,
               "Also write each frame's sums and counts: frame_0001.plate");
  app.add_option("--smooth-below", smooth_below,
                 "Smooth elements with fewer rays than this, over up to 32 elements");
  app.add_option("--fill", fill,
                 "RADIUS or off: an element that no ray reached takes the light of collected ones "
                 "at most RADIUS elements away; it is black if there is none, and its coverage is "
                 "below 1 in any case")
      ->type_name("RADIUS")
      ->check(NotEmpty());
  app.add_option(
         "--mode", mode,
         "collect: frames are the rays that were recorded; rebin: interpolated between rays "
         "that are kept in memory; hybrid: collected, and interpolated where the lens got "
         "no rays")
      ->check(CLI::IsMember({"collect", "rebin", "hybrid"}));
  app.add_option(
         "--estimator", estimator,
         "bilinear (auto): every element reads each LF image where it looks; nearest: every "
         "LF pixel goes to one element, and mosaics are not interpolated")
      ->check(CLI::IsMember({"auto", "nearest", "bilinear"}));
  app.add_option(
         "--filter", filter,
         "Of the estimator bilinear, between LF pixels: nearest, bilinear, bicubic; auto: "
         "bicubic, but bilinear where an element is as large as nine LF pixels or more; "
         "mosaic (auto for mosaics): the same, and colours that the sensor recorded count 8 times "
         "those that were interpolated")
      ->check(CLI::IsMember({"auto", "nearest", "bilinear", "bicubic", "mosaic"}));
  app.add_option(
         "--lens-weights", lens_weights,
         "none: LF images count alike; area: as the part of the lens that is nearest to each; hat: "
         "interpolated, for small lenses and pinholes; auto: area, and hat as the lens closes")
      ->check(CLI::IsMember({"auto", "none", "area", "hat"}));
  app.add_option("--shard", shard,
                 "k/K: plates of the k-th of K parts of the LF images, into DIR/partial/shards; "
                 "lfmerge adds those of all and writes the frames")
      ->check(NotEmpty());
  app.add_option("--rectangles", rectangles,
                 "off: read and try all pixels of every LF image that may contribute, to measure "
                 "what their rectangles save; the same bits")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--back-end", back_end,
                 "fast, or reference: the literal formulas, one ray at a time")
      ->check(CLI::IsMember({"fast", "reference"}));
  rebin.AddTo(app);
}

OfferedOptions RenderArguments::Common() {
  return {.threads = true,
          .seed = "Seed of the order of the LF images, and of which rays are rebinned",
          .strict = "A broken LF image is an error, not left out",
          .progress = true,
          .verbose = true,
          .quiet = true};
}

bool RenderArguments::HasPackages() const {
  return std::all_of(inputs.begin(), inputs.end(), IsPackageName);
}

Result<void> RenderArguments::Check(bool seed_given) const {
  LF_RETURN_IF_ERROR(allow_missing.Limit());
  if (HasPackages()) {
    if (seed_given)
      return UsageError("--seed: packages have the order that they were made with: leave it out");
    if (order != "shuffle")
      return UsageError(
          "--order: packages have the order that they were made with: leave it out, or make them "
          "again by lfpreprocessor --order");
    if (max_angle_deg > 0)
      return UsageError(
          "--max-angle: packages have the LF cameras that they were made with: leave it out, or "
          "make them again by lfpreprocessor --max-angle");
    return light_field.CheckWithPackages();
  }
  if (std::any_of(inputs.begin(), inputs.end(), IsPackageName))
    return UsageError("expected LIGHTFIELD PATH.yaml, or packages alone: PACKAGE...");
  if (inputs.size() != 2)
    return UsageError(
        fmt::format("expected LIGHTFIELD PATH.yaml, or PACKAGE... (files that end in .lfp, such as "
                    "packages/package-0000.lfp); found {} {}",
                    inputs.size(), inputs.size() == 1 ? "word" : "words"));
  if (!light_field.path.empty())
    return UsageError("--lightfield is for packages: here it is the first word");
  return {};
}

Result<RenderOptions> RenderArguments::MakeOptions(const CommonOptions& common, BayerPattern bayer,
                                                   size_t frame_count) const {
  RenderOptions options;
  options.output_folder = output;
  if (!frames.empty()) {
    LF_ASSIGN_OR_RETURN(options.frames, ParseFrameRange(frames, frame_count));
  }
  options.format = *ParseFrameFormat(format);
  if (!video.empty()) options.video = video;
  options.contact_sheet = !no_contact_sheet;
  if (max_images > 0) options.max_image_count = static_cast<size_t>(max_images);
  options.smooth_below = smooth_below;
  LF_ASSIGN_OR_RETURN(options.fill_radius_px, ParseFill(fill));
  LF_ASSIGN_OR_RETURN(options.memory_bytes, ParseByteSize(memory, "--memory"));
  options.strict = common.strict;
  options.whole_images = rectangles == "off";
  options.reading.estimator = estimator == "nearest" ? Estimator::kNearest : Estimator::kBilinear;
  for (const PixelFilter known :
       {PixelFilter::kNearest, PixelFilter::kBilinear, PixelFilter::kBicubic, PixelFilter::kMosaic})
    if (filter == NameOf(known)) options.reading.filter = known;
  for (const LensWeights weights : {LensWeights::kAuto, LensWeights::kArea, LensWeights::kHat})
    if (lens_weights == NameOf(weights)) options.lens_weights = weights;
  for (const RenderMode known : {RenderMode::kRebin, RenderMode::kHybrid})
    if (mode == NameOf(known)) options.mode = known;
  LF_ASSIGN_OR_RETURN(options.rebin, rebin.Make(common.seed));
  if (options.mode == RenderMode::kRebin) options.lens_weights = LensWeights::kNone;
  if (back_end == "reference") options.back_end = CollectBackEnd::kReference;
  options.version = Version();
  LF_ASSIGN_OR_RETURN(options.dump_every_s, ParseDuration(dump_every, "--dump-every"));
  if (!stop_when.empty()) {
    if (IsNoiseRule(stop_when)) {
      LF_ASSIGN_OR_RETURN(options.stop_at_noise, ParseNoiseRule(stop_when, "--stop-when"));
    } else {
      LF_ASSIGN_OR_RETURN(options.stop_at_samples, ParseSampleRule(stop_when, "--stop-when"));
    }
  }
  if (!require.empty()) {
    if (IsNoiseRule(require)) {
      LF_ASSIGN_OR_RETURN(options.require_noise, ParseNoiseRule(require, "--require"));
    } else {
      LF_ASSIGN_OR_RETURN(options.require_samples, ParseSampleRule(require, "--require"));
    }
  }
  if (options.lens_weights == LensWeights::kAuto && options.CountsRays()) {
    options.lens_weights = LensWeights::kNone;
    LogInfo("--lens-weights auto: none, since samples>=N and --smooth-below count rays");
  }
  if (options.reading.filter == PixelFilter::kAuto && !options.CountsRays() &&
      bayer != BayerPattern::kNone)
    options.reading.filter = PixelFilter::kMosaic;
  if (!shard.empty()) {
    options.shard = ShardOf(shard);
    if (!options.shard)
      return UsageError(
          fmt::format("--shard \"{}\": expected k/K, such as 2/5: the second of five", shard));
  }
  if (!finish.empty()) {
    LF_ASSIGN_OR_RETURN(options.finish_early, ParseFrameRange(finish, frame_count, "--finish"));
  }
  options.resume = resume;
  options.overwrite = overwrite;
  options.keep_plates = keep_plates;
  return options;
}

}  // namespace lf
