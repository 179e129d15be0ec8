#include "tools/render_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/common/byte_size.h"
#include "tools/common/duration.h"
#include "tools/common/frame_options.h"
#include "tools/common/help.h"

#include "lf/core/log.h"
#include "lf/core/value_named.h"
#include "lf/film/develop/develop.h"
#include "lf/render/collect/noise_rule.h"
#include "lf/render/package/package_file.h"
#include "lf/render/pipeline/frame_range.h"

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

void AddInput(CLI::App& app, RenderArguments& a) {
  OptionGroup input(app, kInputGroup);
  input
      .Add("INPUT", a.inputs,
           "LIGHTFIELD PATH.yaml, or PACKAGE... of lfpreprocessor\n"
           "LIGHTFIELD: a calibration file or its folder (transforms.json, COLMAP, Middlebury, "
           "LLFF, HCI, AOS), a packed store, or a folder of images with Stanford names\n"
           "PATH.yaml: a camera path (doc/formats/path.md)\n"
           "PACKAGE: a file that lfpreprocessor has written")
      ->required();
  input
      .Add("--lightfield LIGHTFIELD", a.light_field.path,
           "With packages: the place of their LF images\n"
           "Needed if the light field was moved after the packages were made. A packed store of "
           "their LF images is possible as well.")
      ->check(NotEmpty());
  a.light_field.AddOptionsTo(app);
  a.allow_missing.AddTo(
      app, "the LF images that the largest pass reads (with packages, of each package by itself)");
}

void AddOutput(CLI::App& app, RenderArguments& a) {
  OptionGroup output(app, kOutputGroup);
  output.Add("-o,--output DIR", a.output, "Folder of the frames")->required();
  AddFrameRange(output, a.frames);
  AddFrameFormat(output, a.format);
  AddFilmFiles(output, a.video, a.no_contact_sheet);
  output.AddFlag("--keep-plates", a.keep_plates,
                 "Keep the sums and counts of each frame\n"
                 "They are written beside the frame, as frame_0001.plate.");
}

void AddPicture(CLI::App& app, RenderArguments& a) {
  OptionGroup picture(app, kPictureGroup);
  picture.AddChoice("--mode", a.mode, {"collect", "rebin", "hybrid"},
                    "Source of the rays\n"
                    "collect: frames consist of the rays that were recorded\n"
                    "rebin: frames are interpolated between rays that are kept in memory\n"
                    "hybrid: frames are collected, and interpolated where the lens got no rays");
  picture.AddChoice(
      "--estimator", a.estimator, {"auto", "nearest", "bilinear"},
      "How LF pixels contribute to elements\n"
      "bilinear (auto): every element reads each LF image where it looks\n"
      "nearest: every LF pixel goes to one element, and mosaics are not interpolated");
  picture.AddChoice("--filter", a.filter, {"auto", "nearest", "bilinear", "bicubic", "mosaic"},
                    "Interpolation between LF pixels\n"
                    "The filter belongs to the estimator bilinear.\n"
                    "auto: bicubic, but bilinear where an element is as large as nine LF pixels or "
                    "more; for mosaics, mosaic\n"
                    "mosaic: as auto, and colours that the sensor recorded count 8 times as much "
                    "as colours that were interpolated");
  picture.AddChoice("--lens-weights", a.lens_weights, {"auto", "none", "area", "hat"},
                    "Weight of each LF image in a frame\n"
                    "none: all LF images count the same\n"
                    "area: an LF image counts as the part of the lens that is nearest to it\n"
                    "hat: LF images are interpolated, for small lenses and pinholes\n"
                    "auto: area, and hat as the lens closes");
  picture
      .Add("--fill RADIUS|off", a.fill,
           "Radius that fills elements without rays, in elements\n"
           "An element that no ray reached takes the light of collected elements that are at most "
           "RADIUS elements away. It is black if there is none. Its coverage is below 1 in any "
           "case.")
      ->check(NotEmpty());
  picture.Add("--smooth-below N", a.smooth_below,
              "Smooth elements with fewer rays than this (none)\n"
              "Each is smoothed over up to 32 elements.");
}

void AddQuality(CLI::App& app, RenderArguments& a) {
  OptionGroup quality(app, kQualityGroup);
  quality
      .Add("--max-images N", a.max_images,
           "Most LF images that a frame takes (all)\n"
           "A frame takes the first N of the order, which is shuffled by default.")
      ->check(WholeNumber());
  quality
      .Add("--max-angle DEGREES", a.max_angle_deg,
           "Largest angle of an LF camera to the frame's axis (all)\n"
           "A frame takes only LF cameras whose optical axes differ by at most so many degrees "
           "from its own.")
      ->check(CLI::Range(0., 180.));
  quality.AddChoice("--order", a.order, {"shuffle", "round-robin", "area"},
                    "Order of the LF images\n"
                    "The order matters if --max-images or --stop-when end a frame early.\n"
                    "shuffle: random, by --seed\n"
                    "round-robin: all frames fill equally\n"
                    "area: LF images with most rays first");
  quality
      .Add("--stop-when RULE", a.stop_when,
           "Finish a frame early: noise<=X or samples>=N\n"
           "noise<=X: the frame is finished when the noise of 90 % of the elements that LF images "
           "see is at most X. Noise is the standard error of an element's mean, in linear light "
           "with white as 1; 0.002 is half a level of 255 in a mid-grey. The rule works with every "
           "mode and all lens weights; rebin measures the noise by a plate of 24 bytes for each "
           "element of every frame.\n"
           "samples>=N: the frame is finished when 99 % of these elements have N rays in every "
           "channel. Lens weights are then none.")
      ->check(NotEmpty());
  quality
      .Add("--require RULE", a.require,
           "Exit with code 6 unless noise<=X or samples>=N\n"
           "The exit code is 6 if a frame has more noise or fewer rays in the end.")
      ->check(NotEmpty());
}

void AddRunning(CLI::App& app, RenderArguments& a) {
  OptionGroup running(app, kRunningGroup);
  running.Add("--memory SIZE", a.memory, "Bound of the memory used");
  CLI::Option* const resume =
      running.AddFlag("--resume", a.resume,
                      "Continue the render in DIR\n"
                      "The inputs must be the same. Finished frames are kept.");
  running.AddFlag("--overwrite", a.overwrite, "Remove an unfinished render in DIR")
      ->excludes(resume);
  running
      .Add("--finish RANGE", a.finish,
           "With --resume: finish frames with their rays so far\n"
           "RANGE is such as 1-10,20. The other frames are continued. The report says which LF "
           "images the finished frames have.")
      ->check(NotEmpty());
  running.Add("--dump-every TIME", a.dump_every,
              "Time between checkpoints\n"
              "The state is written so often, such as 30s, 10m or 1h; more rarely if it would "
              "take more than 5 % of the time. 0: only at signals.");
  running
      .Add("--shard k/K", a.shard,
           "Render a part of the LF images, for lfmerge\n"
           "Writes the plates of the k-th of K parts of the LF images into DIR/partial/shards. "
           "lfmerge adds the plates of all parts and writes the frames.")
      ->check(NotEmpty());
}

// Reads "samples>=N" or "noise<=X"; an empty text is no rule.
Result<void> ReadRule(const std::string& text, const std::string& option,
                      std::optional<uint32_t>* samples, std::optional<double>* noise) {
  if (text.empty()) return {};
  if (IsNoiseRule(text)) {
    LF_ASSIGN_OR_RETURN(*noise, ParseNoiseRule(text, option));
  } else {
    LF_ASSIGN_OR_RETURN(*samples, ParseSampleRule(text, option));
  }
  return {};
}

void AddMeasuring(CLI::App& app, RenderArguments& a) {
  OptionGroup measuring(app, kMeasuringGroup);
  measuring.AddChoice("--rectangles", a.rectangles, {"on", "off"},
                      "Read only the needed rectangle of each LF image\n"
                      "off: all pixels of every LF image that may contribute are read and tried, "
                      "to measure what the rectangles save. The frames have the same bits.");
  measuring.AddChoice("--back-end", a.back_end, {"fast", "reference"},
                      "Code that adds the rays\n"
                      "reference: the literal formulas, one ray at a time");
}

}  // namespace

void RenderArguments::AddTo(CLI::App& app) {
  AddInput(app, *this);
  AddOutput(app, *this);
  AddPicture(app, *this);
  AddQuality(app, *this);
  AddRunning(app, *this);
  rebin.AddTo(app);
  AddMeasuring(app, *this);
}

OfferedOptions RenderArguments::Common() {
  return {.threads = true,
          .seed = "Seed of the order, and of the rebinned rays",
          .strict =
              "Stop at a missing or broken LF image\n"
              "Otherwise it is left out.",
          .json = "Print the report to stdout",
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

Result<FilmOptions> RenderArguments::MakeFilm(uint64_t seed) const {
  FilmOptions film;
  if (max_images > 0) film.max_image_count = static_cast<size_t>(max_images);
  film.smooth_below = smooth_below;
  LF_ASSIGN_OR_RETURN(film.fill_radius_px, ParseFill(fill));
  film.reading.estimator = estimator == "nearest" ? Estimator::kNearest : Estimator::kBilinear;
  film.reading.filter = ValueNamed(filter, {PixelFilter::kNearest, PixelFilter::kBilinear,
                                            PixelFilter::kBicubic, PixelFilter::kMosaic})
                            .value_or(PixelFilter::kAuto);
  film.lens_weights = *LensWeightsOf(lens_weights);
  film.mode = *RenderModeOf(mode);
  LF_ASSIGN_OR_RETURN(film.rebin, rebin.Make(seed));
  if (back_end == "reference") film.back_end = CollectBackEnd::kReference;
  LF_RETURN_IF_ERROR(
      ReadRule(stop_when, "--stop-when", &film.stop_at_samples, &film.stop_at_noise));
  LF_RETURN_IF_ERROR(ReadRule(require, "--require", &film.require_samples, &film.require_noise));
  if (film.mode != RenderMode::kRebin && film.lens_weights == LensWeights::kAuto &&
      film.CountsRays())
    LogInfo("--lens-weights auto: none, since samples>=N and --smooth-below count rays");
  if (!shard.empty()) {
    film.shard = ShardOf(shard);
    if (!film.shard)
      return UsageError(
          fmt::format("--shard \"{}\": expected k/K, such as 2/5: the second of five", shard));
  }
  return film;
}

Result<FolderOptions> RenderArguments::MakeFolder(size_t frame_count) const {
  FolderOptions folder;
  folder.output_folder = output;
  folder.format = *ParseFrameFormat(format);
  if (!video.empty()) folder.video = video;
  folder.contact_sheet = !no_contact_sheet;
  folder.keep_plates = keep_plates;
  LF_ASSIGN_OR_RETURN(folder.dump_every_s, ParseDuration(dump_every, "--dump-every"));
  folder.resume = resume;
  folder.overwrite = overwrite;
  if (!finish.empty()) {
    LF_ASSIGN_OR_RETURN(folder.finish_early, ParseFrameRange(finish, frame_count, "--finish"));
  }
  folder.version = Version();
  return folder;
}

Result<RenderOptions> RenderArguments::MakeOptions(const CommonOptions& common,
                                                   size_t frame_count) const {
  RenderOptions options;
  if (!frames.empty()) {
    LF_ASSIGN_OR_RETURN(options.frames, ParseFrameRange(frames, frame_count));
  }
  LF_ASSIGN_OR_RETURN(options.film, MakeFilm(common.seed));
  LF_ASSIGN_OR_RETURN(options.work.memory_bytes, ParseByteSize(memory, "--memory"));
  options.work.strict = common.strict;
  options.work.whole_images = rectangles == "off";
  LF_ASSIGN_OR_RETURN(options.folder, MakeFolder(frame_count));
  return options;
}

}  // namespace lf
