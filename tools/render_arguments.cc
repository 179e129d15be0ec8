// SPDX-License-Identifier: Apache-2.0
#include "tools/render_arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/common/help.h"
#include "tools/common/next_step.h"
#include "tools/common/store_options.h"
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

void AddInput(CLI::App& app, RenderArguments& a) {
  OptionGroup input(app, kInputGroup);
  input
      .Add("INPUT", a.inputs,
           "LIGHTFIELD PATH, or PACKAGE... of lfpreprocessor\n"
           "LIGHTFIELD: a calibration file or its folder (transforms.json, COLMAP, Middlebury, "
           "LLFF, HCI, AOS, exports of other programs), a packed store, or a folder of images with "
           "Stanford names\n"
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
  a.light_field.AddReduceTo(app);
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
  a.settings.AddTo(picture, SettingGroup::kPicture);
  CLI::Option* const densify = picture.AddFlag(
      "--densify", a.densify,
      "Put virtual LF images between the recorded ones\n"
      "Makes DIR/densified.lfs as lfdensify does for the path, with its default options, and "
      "renders it (doc/densify.md). The store is kept and used again for the same light field and "
      "path; --resume continues it, and --overwrite makes it anew. A light field that is dense "
      "enough is rendered as it is.");
  AddDepthCache(picture, a.cache)->needs(densify);
  picture.AddFlag(
      "--no-guard", a.no_guard,
      "Show virtual LF images where a frame is in focus\n"
      "Frames of a densified light field show the rays of recorded LF images alone where they are "
      "in focus. With this option they show those of all LF images everywhere.");
}

void AddQuality(CLI::App& app, RenderArguments& a) {
  OptionGroup quality(app, kQualityGroup);
  a.settings.AddTo(quality, SettingGroup::kQuality);
}

void AddRebinning(CLI::App& app, RenderArguments& a) {
  OptionGroup rebinning(app, "Rebinned rays (--mode rebin, hybrid; doc/rebinning.md)");
  a.settings.AddTo(rebinning, SettingGroup::kRebinning);
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
          "rank in the order of the light field, from 0, is below finished_early_before_rank.")
      ->check(NotEmpty());
  AddDumpEvery(running, a);
  running
      .Add("--shard k/K", a.shard,
           "Render part k of K of the LF images, for lfmerge\n"
           "Writes the plates of this part into DIR/partial/shards. lfmerge adds the plates of all "
           "K parts and writes the frames.")
      ->check(NotEmpty());
}

void AddMeasuring(CLI::App& app, RenderArguments& a) {
  OptionGroup measuring(app, kMeasuringGroup);
  measuring.AddChoice("--rectangles", a.rectangles, {"on", "off"},
                      "Read only the needed rectangle of each LF image\n"
                      "off: all pixels of every LF image that may contribute are read, to measure "
                      "what the rectangles save. The frames are bit-identical.");
  a.settings.AddTo(measuring, SettingGroup::kMeasuring);
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
  AddRebinning(app, *this);
  AddMeasuring(app, *this);
}

void RenderArguments::AddRenderingTo(CLI::App& app) {
  AddPicture(app, *this);
  AddQuality(app, *this);
  OptionGroup running(app, kRunningGroup);
  AddMemory(running, *this);
  AddDumpEvery(running, *this);
  AddRebinning(app, *this);
  AddMeasuring(app, *this);
}

OfferedOptions RenderArguments::Common() {
  return {.threads = true,
          .seed = "Seed of --order and --kept edges",
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
    FilmSettings film;
    LF_RETURN_IF_ERROR(settings.Set(&film));
    if (film.order != FilmSettings().order)
      return UsageError(
          "--order cannot be used with packages, which contain the order that lfpreprocessor was "
          "given: leave it out, or make the packages again with lfpreprocessor --order");
    if (film.max_angle_rad)
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
  LF_RETURN_IF_ERROR(settings.Set(&film));
  film.seed = seed;
  film.guard = !no_guard;
  film.adds_opacity = picture.HasAlpha();
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

Result<FolderOptions> RenderArguments::MakeFolder(const FrameNumbers& all) const {
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
    LF_ASSIGN_OR_RETURN(folder.finish_early, ParseFrameRange(finish, all, "--finish"));
  }
  folder.version = Version();
  return folder;
}

Result<RenderOptions> RenderArguments::MakeOptions(const CommonOptions& common,
                                                   const FrameNumbers& all) const {
  RenderOptions options;
  LF_ASSIGN_OR_RETURN(options.frames, frames.Of(all));
  LF_ASSIGN_OR_RETURN(options.film, MakeFilm(common.seed));
  LF_ASSIGN_OR_RETURN(options.work.memory_bytes, ParseByteSize(memory, "--memory"));
  options.work.strict = common.strict;
  options.work.whole_images = rectangles == "off";
  LF_ASSIGN_OR_RETURN(options.folder, MakeFolder(all));
  return options;
}

}  // namespace lf
