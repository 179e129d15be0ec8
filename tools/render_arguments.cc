// SPDX-License-Identifier: Apache-2.0
#include "tools/render_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/common/help.h"
#include "tools/common/next_step.h"
#include "tools/common/validators.h"

#include "lf/core/geometry.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/core/value_named.h"
#include "lf/core/version.h"
#include "lf/film/develop/develop.h"
#include "lf/render/collect/noise_rule.h"
#include "lf/render/package/package_file.h"
#include "lf/render/pipeline/frame_range.h"

namespace lf {
namespace {

// Parses the value of --fill: a radius in elements, or "off", which is 0.
Result<int> ParseFill(const std::string& text) {
  if (text == "off") return 0;
  const std::optional<int> radius_px = ParseWhole<int>(text);
  if (radius_px && *radius_px >= 0 && *radius_px <= kMostFillRadius_px) return *radius_px;
  return UsageError(fmt::format("--fill {}: expected a number of elements from 0 to {}, or off",
                                text, kMostFillRadius_px));
}

void AddInput(CLI::App& app, RenderArguments& a) {
  OptionGroup input(app, kInputGroup);
  input
      .Add("INPUT", a.inputs,
           "LIGHTFIELD PATH, or PACKAGE... of lfpreprocessor\n"
           "LIGHTFIELD: a calibration file or its folder (transforms.json, COLMAP, Middlebury, "
           "LLFF, HCI, AOS), a packed store, or a folder of images with Stanford names\n"
           "PATH: a camera path of our own (doc/formats/path.md), of another program, or the "
           "cameras of a "
           "calibration (doc/formats/foreign_paths.md)\n"
           "PACKAGE: a file that lfpreprocessor has written")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles("light_field path package"));
  input
      .Add("--lightfield LIGHTFIELD", a.light_field.path,
           "Light field of the packages, if it was moved\n"
           "Packages state where their light field was when they were made. LIGHTFIELD may be a "
           "packed store that contains their LF images.")
      ->check(NotEmpty());
  a.light_field.AddOptionsTo(app);
  a.allow_missing.AddTo(
      app, "the LF images that the largest pass reads (with packages: that each package reads)");
}

void AddOutput(CLI::App& app, RenderArguments& a) {
  OptionGroup output(app, kOutputGroup);
  output.Add("-o,--output DIR", a.output, "Folder of the frames")->required();
  a.frames.AddTo(output, "render", "nothing is rendered");
  AddFrameFormat(output, a.format);
  a.picture.AddTo(output);
  AddFilmFiles(output, a.video, a.no_contact_sheet);
  output.AddFlag("--keep-plates", a.keep_plates,
                 "Also write the ray sums and counts of each frame\n"
                 "They are written into a file beside the frame, such as frame_0001.plate. lfmerge "
                 "can make the frame from this file again.");
}

void AddPicture(CLI::App& app, RenderArguments& a) {
  OptionGroup picture(app, kPictureGroup);
  picture.AddChoice(
      "--mode", a.mode, {"collect", "rebin", "hybrid"},
      "How frames are made from recorded rays\n"
      "collect: frames are averages of the recorded rays\n"
      "rebin: frames are interpolated between rays that are kept in memory\n"
      "hybrid: frames are collected; where no recorded ray passes the lens, they are interpolated");
  picture.AddChoice(
      "--estimator", a.estimator, {"auto", "nearest", "bilinear"},
      "How LF pixels contribute to elements\n"
      "An element is a pixel of the frame before it is developed.\n"
      "auto, bilinear: every element reads each LF image at the point that it sees, interpolated "
      "as --filter says\n"
      "nearest: every LF pixel is added to one element; mosaics are not interpolated");
  picture.AddChoice(
      "--filter", a.filter, {"auto", "nearest", "bilinear", "bicubic", "mosaic", "prefiltered"},
      "Interpolation between LF pixels\n"
      "Used by --estimator bilinear.\n"
      "auto: mosaic for mosaics, bicubic for brackets (LF images of one pose with different "
      "exposures), otherwise prefiltered\n"
      "prefiltered: each LF image is first filtered for the size of elements, then interpolated "
      "linearly; sharper than bicubic and faster\n"
      "mosaic: bicubic, or bilinear where an element is more than two LF pixels wide; "
      "colours that the sensor recorded count 8 times as much as interpolated colours");
  picture.AddChoice("--lf-pixels", a.lf_pixels, {"auto", "areas", "points"},
                    "What LF pixels show, for --filter prefiltered\n"
                    "areas: the mean light of their area, as in photographs\n"
                    "points: the light of their centre, as in renders without anti-aliasing\n"
                    "auto: as lf_pixels of the light field says, otherwise measured");
  picture.AddChoice(
      "--lens-weights", a.lens_weights, {"auto", "none", "area", "hat"},
      "Weight of each LF image in a frame\n"
      "none: all LF images have the same weight\n"
      "area: the weight of an LF image is the area of the lens that is nearer to its LF camera "
      "than to any other\n"
      "hat: interpolation between the nearest LF images, for small lenses and pinholes\n"
      "auto: area for large lenses, hat for small ones, a mix of both in between");
  picture.AddFlag(
      "--densify", a.densify,
      "Put virtual LF images between the recorded ones\n"
      "Makes DIR/densified.lfs as lfdensify does for the path, with its default options, and "
      "renders it (doc/densify.md). The store is kept and used again for the same light field and "
      "path; --resume continues it, and --overwrite makes it anew. A light field that is dense "
      "enough is rendered as it is.");
  picture.AddFlag(
      "--no-guard", a.no_guard,
      "Show virtual LF images where a frame is in focus\n"
      "Frames of a densified light field show the rays of recorded LF images alone where they are "
      "in focus. With this option they show those of all LF images everywhere.");
  picture
      .Add("--fill RADIUS|off", a.fill,
           "Radius for filling elements without rays, in elements\n"
           "An element without rays gets the mean light of collected elements at most RADIUS "
           "elements away, or black if there is none. Its coverage stays below 1.\n"
           "off: elements without rays are black")
      ->check(NotEmpty());
  picture.Add("--smooth-below N", a.smooth_below,
              "Smooth elements with fewer rays than this (none)\n"
              "Such an element is averaged with its neighbours, up to 32 elements away.");
}

void AddQuality(CLI::App& app, RenderArguments& a) {
  OptionGroup quality(app, kQualityGroup);
  quality.Add("--max-images N", a.max_images,
              "Maximum number of LF images per frame (all)\n"
              "A frame uses the first N of the LF images that contribute to it, in the order of "
              "--order, which is random by default.");
  quality
      .Add("--max-angle DEGREES", a.max_angle_deg,
           "Largest angle between LF camera and frame axes (no limit)\n"
           "A frame uses only LF cameras whose optical axis is within DEGREES of its own optical "
           "axis.")
      ->check(CLI::Range(0., 180.));
  quality.AddChoice("--order", a.order, {"shuffle", "round-robin", "area"},
                    "Order in which frames take LF images\n"
                    "The order matters if --max-images or --stop-when end a frame early.\n"
                    "shuffle: random, by --seed\n"
                    "round-robin: always an LF image for the frame with the fewest rays\n"
                    "area: LF images with the most rays first");
  quality
      .Add("--stop-when RULE", a.stop_when,
           "Finish a frame early: noise<=X or samples>=N\n"
           "noise<=X: the frame is finished when at least 90 % of the elements that LF images see "
           "have a noise of at most X. The noise of an element is the standard error of its mean, "
           "in linear light where white is 1; 0.002 is half an 8-bit level in a mid-grey. Works "
           "with every --mode and all --lens-weights. With --mode rebin it needs 24 bytes of "
           "memory for each element of every frame.\n"
           "samples>=N: the frame is finished when at least 99 % of the elements that LF images "
           "see have N rays in every colour channel. --lens-weights auto then means none.")
      ->check(NotEmpty());
  quality
      .Add("--require RULE", a.require,
           "Exit with code 6 unless noise<=X or samples>=N\n"
           "The rules are those of --stop-when. The exit code is 6 if a finished frame has more "
           "noise or fewer rays than the rule says.")
      ->check(NotEmpty());
}

void AddMemory(OptionGroup& running, RenderArguments& a) {
  running.Add(
      "--memory SIZE", a.memory,
      "Upper limit of the memory that is used\n"
      "SIZE: such as 8G or 512M. With less memory, the frames are rendered in more passes.");
}

void AddDumpEvery(OptionGroup& running, RenderArguments& a) {
  running.Add("--dump-every TIME", a.dump_every,
              "Time between checkpoints\n"
              "A render that is killed loses the work since its last checkpoint. TIME is a number "
              "with a unit, such as 30s, 10m or 1h. The time between checkpoints is longer if "
              "writing them would otherwise take more than 5 % of the time. 0: checkpoints are "
              "only written at signals, such as Ctrl-C.");
}

void AddRunning(CLI::App& app, RenderArguments& a) {
  OptionGroup running(app, kRunningGroup);
  AddMemory(running, a);
  CLI::Option* const resume = running.AddFlag(
      "--resume", a.resume,
      "Continue the unfinished render in DIR\n"
      "The inputs and the options that change frames must be the same. Finished frames are kept.");
  running
      .AddFlag(
          "--overwrite", a.overwrite,
          "Remove an unfinished render in DIR and start anew\n"
          "Needed, unless --resume is given, if DIR has an unfinished render, or frames of another "
          "film that this one does not replace. Finished frames in DIR are replaced one by one; "
          "only --resume keeps them. Frames of another film or in another --format stay, and a "
          "warning names them.")
      ->excludes(resume);
  running
      .Add(
          "--finish RANGE", a.finish,
          "Finish frames of the resumed render with their rays so far\n"
          "Needs --resume. RANGE: the frames to finish, such as 1-10,20. They are written with the "
          "rays that the unfinished render has of them, and get no more; a frame without rays is "
          "rendered as usual. The other frames are continued. For each frame that is finished in "
          "this way, the report states how far it got: it contains those of its LF images whose "
          "rank in the order of the light field, from 0, is below finished_early_before_place.")
      ->check(NotEmpty());
  AddDumpEvery(running, a);
  running
      .Add("--shard k/K", a.shard,
           "Render part k of K of the LF images, for lfmerge\n"
           "Writes the plates of this part into DIR/partial/shards. lfmerge adds the plates of all "
           "K parts and writes the frames.")
      ->check(NotEmpty());
}

// Reads "samples>=N" into *samples, or "noise<=X" into *noise; an empty text is no rule.
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
                      "off: all pixels of every LF image that may contribute are read, to measure "
                      "what the rectangles save. The frames are bit-identical.");
  measuring.AddChoice("--back-end", a.back_end, {"fast", "reference"},
                      "Implementation of the ray model\n"
                      "fast: the quick implementation\n"
                      "reference: the formulas applied literally, one ray at a time");
}

// Returns the command of lfdensify that makes `store`.
//   words  LIGHTFIELD and PATH
std::string DensifyCommand(std::vector<std::string> words, const LightFieldArgument& light_field,
                           const std::string& store) {
  for (std::string& word : words) word = FileArgument(word);
  words.insert(words.begin(), "lfdensify");
  words.insert(words.end(), {"-o", store});
  const std::vector<std::string> options = light_field.Words();
  words.insert(words.end(), options.begin(), options.end());
  return ShellCommand(words);
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

void RenderArguments::AddRenderingTo(CLI::App& app) {
  AddPicture(app, *this);
  AddQuality(app, *this);
  OptionGroup running(app, kRunningGroup);
  AddMemory(running, *this);
  AddDumpEvery(running, *this);
  rebin.AddTo(app);
  AddMeasuring(app, *this);
}

OfferedOptions RenderArguments::Common() {
  return {.threads = true,
          .seed = "Seed of --order shuffle and of --kept edges",
          .strict =
              "Stop at a missing or broken LF image\n"
              "Without this option it is left out.",
          .json = "Print the report to stdout as JSON",
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
      return UsageError(
          "--seed cannot be used with packages, which contain the seed that lfpreprocessor was "
          "given: leave it out, or make the packages again with lfpreprocessor --seed");
    if (order != "shuffle")
      return UsageError(
          "--order cannot be used with packages, which contain the order that lfpreprocessor was "
          "given: leave it out, or make the packages again with lfpreprocessor --order");
    if (max_angle_deg > 0)
      return UsageError(
          "--max-angle cannot be used with packages, because lfpreprocessor has already selected "
          "their LF cameras: leave it out, or make the packages again with lfpreprocessor "
          "--max-angle");
    if (densify)
      return UsageError(
          "--densify cannot be used with packages, which were made of the LF images that exist: "
          "densify the light field with lfdensify, and make packages of STORE.lfs");
    return light_field.CheckWithPackages();
  }
  if (std::any_of(inputs.begin(), inputs.end(), IsPackageName))
    return UsageError(
        "packages and other inputs are given: expected LIGHTFIELD PATH, or only packages "
        "(files that end in .lfp)");
  if (inputs.size() != 2)
    return UsageError(fmt::format(
        "{} {} given, expected LIGHTFIELD PATH, or packages (files that end in .lfp, such as "
        "packages/package-0000.lfp)",
        inputs.size(), inputs.size() == 1 ? "input is" : "inputs are"));
  if (densify && !shard.empty()) {
    const std::string store = FreeName("dense", ".lfs");
    return UsageError(
        fmt::format("--densify cannot be used with --shard, because all shards need the same "
                    "virtual LF images: give {} to the shards as their light field; to make it: {}",
                    store, DensifyCommand(inputs, light_field, store)));
  }
  if (!light_field.path.empty())
    return UsageError(
        "--lightfield can only be used with packages: give the light field as the first argument "
        "instead, before PATH");
  return {};
}

Result<FilmSettings> RenderArguments::MakeFilm(uint64_t seed) const {
  FilmSettings film;
  film.order = *ImageOrderOf(order);
  film.seed = seed;
  if (max_angle_deg > 0) film.max_angle_rad = RadiansFromDegrees(max_angle_deg);
  if (max_images > 0) film.max_image_count = static_cast<size_t>(max_images);
  film.smooth_below = smooth_below;
  LF_ASSIGN_OR_RETURN(film.fill_radius_px, ParseFill(fill));
  film.reading.estimator = estimator == "nearest" ? Estimator::kNearest : Estimator::kBilinear;
  film.reading.filter =
      ValueNamed(filter, {PixelFilter::kNearest, PixelFilter::kBilinear, PixelFilter::kBicubic,
                          PixelFilter::kMosaic, PixelFilter::kPrefiltered})
          .value_or(PixelFilter::kAuto);
  film.reading.footprint = PixelFootprintOf(lf_pixels);
  film.lens_weights = *LensWeightsOf(lens_weights);
  film.mode = *RenderModeOf(mode);
  film.guard = !no_guard;
  film.adds_opacity = picture.alpha;
  LF_ASSIGN_OR_RETURN(film.rebin, rebin.Make());
  if (back_end == "reference") film.back_end = CollectBackEnd::kReference;
  LF_RETURN_IF_ERROR(
      ReadRule(stop_when, "--stop-when", &film.stop_at_samples, &film.stop_at_noise));
  LF_RETURN_IF_ERROR(ReadRule(require, "--require", &film.require_samples, &film.require_noise));
  if (film.mode != RenderMode::kRebin && film.lens_weights == LensWeights::kAuto &&
      film.CountsRays())
    LogInfo(
        "--lens-weights auto means none here, because samples>=N and --smooth-below count rays");
  if (!shard.empty()) {
    film.shard = ShardOf(shard);
    if (!film.shard)
      return UsageError(
          fmt::format("--shard \"{}\": expected k/K, such as 2/5 for part 2 of 5", shard));
  }
  return film;
}

Result<FolderOptions> RenderArguments::MakeFolder(size_t frame_count) const {
  FolderOptions folder;
  folder.output_folder = output;
  folder.format = *ParseFrameFormat(format);
  LF_ASSIGN_OR_RETURN(folder.picture, picture.Make(folder.format));
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
  LF_ASSIGN_OR_RETURN(options.frames, frames.Of(frame_count));
  LF_ASSIGN_OR_RETURN(options.film, MakeFilm(common.seed));
  LF_ASSIGN_OR_RETURN(options.work.memory_bytes, ParseByteSize(memory, "--memory"));
  options.work.strict = common.strict;
  options.work.whole_images = rectangles == "off";
  LF_ASSIGN_OR_RETURN(options.folder, MakeFolder(frame_count));
  return options;
}

}  // namespace lf
