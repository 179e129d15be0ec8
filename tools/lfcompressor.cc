// SPDX-License-Identifier: Apache-2.0
// lfcompressor LIGHTFIELD|PACKAGE... -o STORE.lfs: compresses a light field into a packed store.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/store_options.h"
#include "tools/common/validators.h"

#include "lf/core/parallel.h"
#include "lf/core/quantities.h"
#include "lf/core/shell_word.h"
#include "lf/core/version.h"
#include "lf/distribute/compress/codec_words.h"
#include "lf/distribute/compress/compress.h"
#include "lf/distribute/compress/compress_report.h"
#include "lf/distribute/compress/demosaicked_images.h"
#include "lf/distribute/compress/image_use.h"
#include "lf/import/formats/light_field_words.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/render/package/package_file.h"
#include "lf/render/pipeline/render_packages.h"
#include "lf/storage/packed/packed_store_file.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfcompressor"),
    .usage = R"(  lfcompressor LIGHTFIELD -o STORE.lfs [OPTIONS]
  lfcompressor PACKAGE... -o STORE.lfs [OPTIONS])",
    .examples = R"(  lfcompressor capture/ -o capture.lfs                        # about 45 dB
  lfcompressor capture/ -o capture.lfs --profile lossless     # lossless
  lfcompressor capture/ -o capture.lfs --target-psnr 42 --verify
  lfcompressor capture/ -o capture.lfs --by-resolution        # for a web server
  lfcompressor mosaics/ -o rgb.lfs --demosaic joint           # mosaics with their neighbours
  lfcompressor packages/package-*.lfp -o film.lfs             # only the part that a film needs
  lfcompressor capture.lfs -o served.lfs --by-resolution      # copies what is encoded already
  lfrenderer capture.lfs path.yaml -o frames                  # a store is a LIGHTFIELD
  lfrenderer packages/package-0000.lfp --lightfield film.lfs -o frames)",
    .details =
        R"(STORE.lfs contains the LF images, each encoded by itself or in groups, and their calibration. It is
one file that every program accepts as LIGHTFIELD (doc/formats/packed_store.md). Until it is
complete its name is STORE.lfs.unfinished. Ctrl-C, kill -9 or a crash lose about two seconds of
work, or the groups in work; --resume continues.

A store of packages has the calibration of all LF cameras, and the LF images that the packages need.
A film of these packages that is rendered from the store alone has the bits of a film that is
rendered from a store of the whole light field. A film that needs other pixels is refused.

Encoded images of a packed store are copied without a loss, for a store of packages, of shards or by
resolution.

LF images that are missing or broken are left out of the store, and the exit code is then 6. While
the store is unfinished, --resume tries to read them again. To add them to a finished store, make it
again with --overwrite.)",
};

struct Arguments {
  std::vector<std::string> inputs;
  lf::LightFieldArgument light_field;
  lf::CodecWords codec;
  std::string output, shard_size;
  bool by_resolution = false;
  bool needed_pixels = false, resume = false, overwrite = false, verify = false;
  lf::AllowMissing allow_missing;
};

void AddInput(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup);
  input
      .Add("INPUT", a.inputs,
           "LIGHTFIELD, or PACKAGE... of lfpreprocessor\n"
           "LIGHTFIELD: a light field of any supported kind; encoded images of a packed store are "
           "copied\n"
           "PACKAGE: a file that lfpreprocessor has written (NAME.lfp)")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles("light_field package"));
  input
      .Add("--lightfield LIGHTFIELD", a.light_field.path,
           "Light field of the packages, if it was moved\n"
           "Packages state where their light field was when they were made.")
      ->check(lf::NotEmpty());
  input.AddFlag(
      "--needed-pixels", a.needed_pixels,
      "Store only the pixels that the packages need\n"
      "For each LF image, the smallest rectangle that contains these pixels is stored. Frames "
      "of other packages may need pixels that the store lacks.");
  a.light_field.AddOptionsTo(app);
  a.allow_missing.AddTo(app, "the LF images to be encoded");
}

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  lf::AddStoreOutput(output, a.output);
  output
      .Add("--shard-size SIZE", a.shard_size,
           "Split the store into files of about this size\n"
           "The encoded images are written into files beside STORE.lfs, each of about SIZE, such "
           "as 4G. STORE.lfs itself is then small, and needs these files beside it.")
      ->check(lf::NotEmpty());
  output.AddFlag(
      "--by-resolution", a.by_resolution,
      "Split the store by resolution, for copies over a network\n"
      "The encoded images are written into files beside STORE.lfs. STORE-r0.lfs has the smallest "
      "pictures of all LF images, and each further file, up to STORE-r3.lfs, doubles their "
      "resolution. Without the last files the store is a coarser light field, and if a file is "
      "incomplete, some LF images are missing. Image files are encoded also if they are smaller, "
      "unless the profile is recorded.");
}

void AddQuality(CLI::App& app, Arguments& a) {
  lf::OptionGroup quality(app, lf::kQualityGroup);
  quality.AddChoice(
      "--profile", a.codec.profile,
      {"default", "thesis", "lossless", "recorded", "group", "group-lossless", "auto"},
      "How to encode\n"
      "default: lossy, wavelets with a dead-zone quantiser for each subband\n"
      "thesis: lossy, Haar wavelets with one threshold and one range of values for all subbands\n"
      "lossless: the decoded pixels equal those of the image files bit by bit\n"
      "recorded: image files are kept as they are, with their EXIF data. The profiles default and "
      "lossless keep those "
      "that are smaller than their encoded images, such as most JPEG files.\n"
      "group: as default, but LF images are predicted from a few others nearby where that saves a "
      "tenth. Clean captures take about half the bytes; decoding takes about four times as long\n"
      "group-lossless: the same without loss\n"
      "auto: tries a sample, and takes group if prediction saves a tenth, otherwise default, or "
      "recorded if all files are smaller");
  quality.AddChoice(
      "--entropy", a.codec.entropy, {"auto", "packed", "contexts"},
      "How wavelet coefficients become bytes\n"
      "auto: contexts for LF images in groups, packed for others\n"
      "packed: several in a byte, compressed by zstd\n"
      "contexts: each by what its neighbours predict, for slow networks and small disks. The same "
      "pixels take 3 to 29 % fewer bytes, but decoding takes two to three times as long. Not for "
      "--profile "
      "thesis.");
  quality.AddChoice(
      "--demosaic", a.codec.demosaic, {"none", "joint"},
      "Make RGB LF images of mosaics\n"
      "none: the store has the mosaics, which are demosaicked whenever they are loaded\n"
      "joint: missing colours are taken from what neighbouring LF images recorded, a pixel or "
      "three away. Frames are 1 to 3 dB nearer to the truth where an element has the rays of up to "
      "some dozens of LF images; with hundreds, mosaics may be as good. It takes about 8 "
      "microseconds for each pixel on one core. Not for packages, and not with --profile recorded "
      "or auto");
  quality.AddFlag("--reencode", a.codec.reencode,
                  "Encode all LF images, also those whose files are smaller\n"
                  "Encoded images take less time to load than JPEG files.");
  quality
      .Add("--levels N", a.codec.levels,
           "Levels of the wavelet transform (4, thesis: 1)\n"
           "Each level halves the resolution of the approximation. 0: 4 levels, or 1 level with "
           "--profile thesis.")
      ->check(CLI::Range(0, 5));
  auto* threshold = quality
                        .Add("--threshold X", a.codec.threshold,
                             "Drop details below this (3, thesis: 8)\n"
                             "Wavelet coefficients smaller than X become 0. The unit of X is 1/255 "
                             "of the range from black to white. If the option is not given, X is "
                             "3, or 8 with --profile thesis. Not for --profile lossless.")
                        ->check(CLI::Range(0., 255.));
  quality
      .Add(
          "--target-psnr DB", a.codec.target_psnr,
          "Find the threshold for this quality (off)\n"
          "The value of --threshold is chosen so that a sample of the LF images, when decoded, has "
          "at least this peak signal-to-noise ratio (PSNR), in dB. Not for --profile lossless.")
      ->check(CLI::Range(10., 90.))
      ->excludes(threshold);
  quality.AddFlag(
      "--quality-by-use", a.codec.quality_by_use,
      "Encode LF images that the film uses most with the best quality\n"
      "For packages only. The threshold of each LF image is --threshold times a factor from 1/2 to "
      "2 that follows from its lens weights in all frames of the packages. Frames have about the "
      "quality of --threshold, in fewer bytes. --target-psnr is then the predicted PSNR of the "
      "frames. Other films that are rendered from the store may have a lower quality, and a "
      "warning "
      "says so.");
  quality.Add("--quantizer N", a.codec.quantizer,
              "Values per coefficient, for --profile thesis\n"
              "Wavelet coefficients are rounded to N values, 2 to 65536. 8bit: 256 values, which "
              "take one byte per coefficient. More than 256 values take two bytes.");
}

void AddRunning(CLI::App& app, Arguments& a) {
  lf::OptionGroup running(app, lf::kRunningGroup);
  lf::AddStoreRestart(running, a.resume, a.overwrite);
  running.AddFlag(
      "--verify", a.verify,
      "Check the store after writing it\n"
      "Compares the calibration, encodes each LF image again, compares it with the encoded image "
      "in the store, and decodes that. If a complete store exists already and --overwrite is not "
      "given, that store is only checked.");
}

void AddOptions(CLI::App& app, Arguments& a) {
  AddInput(app, a);
  AddOutput(app, a);
  AddQuality(app, a);
  AddRunning(app, a);
}

bool HasPackages(const Arguments& a) {
  return std::all_of(a.inputs.begin(), a.inputs.end(), lf::IsPackageName);
}

lf::Result<lf::CompressOptions> MakeOptions(const Arguments& a, const lf::CommonOptions& common) {
  lf::CompressOptions options;
  options.store = a.output;
  if (options.store.extension() != lf::kStoreExtension)
    return lf::UsageError(
        fmt::format("-o {}: expected a file name that ends in {}", a.output, lf::kStoreExtension));
  if (a.by_resolution && !a.shard_size.empty())
    return lf::UsageError(
        "--by-resolution and --shard-size exclude each other, because each says into which files "
        "the store is split: leave one of them out");
  if (a.by_resolution && a.needed_pixels)
    return lf::UsageError(
        "--by-resolution and --needed-pixels exclude each other, because smaller pictures are made "
        "of whole LF images: leave one of them out");
  if (a.by_resolution && (a.codec.profile.starts_with("group") || a.codec.profile == "auto"))
    return lf::UsageError(fmt::format(
        "--by-resolution cannot be used with --profile {}, because LF images that are predicted "
        "from others have no smaller pictures: leave one of them out",
        a.codec.profile));
  options.by_resolution = a.by_resolution;
  lf::CodecWords codec = a.codec;
  if (a.by_resolution && codec.profile != "recorded") codec.reencode = true;
  LF_RETURN_IF_ERROR(lf::SetCodec(codec, &options));
  if (!a.shard_size.empty()) {
    LF_ASSIGN_OR_RETURN(options.shard_bytes, lf::ParseByteSize(a.shard_size, "--shard-size"));
  }
  options.resume = a.resume;
  options.overwrite = a.overwrite;
  options.verify = a.verify;
  options.strict = common.strict;
  options.source_name = a.inputs.front();
  options.version = lf::Version();
  return options;
}

// Opens the light field that a package was made from, with the options that it was opened with
// then. The store has all LF cameras, and a package has only some of them.
lf::Result<lf::LightField> OpenSourceOf(const lf::Package& package, const std::string& path) {
  const auto open = [&]() -> lf::Result<lf::LightField> {
    const std::filesystem::path& source = package.source.light_field;
    LF_ASSIGN_OR_RETURN(const lf::LightFieldWords words,
                        lf::LightFieldWords::Of(source.string(), package.source.options));
    LF_ASSIGN_OR_RETURN(const lf::OpenOptions options, words.Options());
    return lf::OpenLightField(source, options);
  };
  lf::Result<lf::LightField> opened = open();
  if (opened) return opened;
  return lf::InputError(fmt::format(
      "{}: the light field that it was made from, with the calibration of all LF cameras, cannot "
      "be opened ({}): give it with --lightfield, and with --images if its LF images lie elsewhere",
      path, opened.error().message));
}

// Returns the line that advises how to render from the store: the packages that it was made from,
// which have everything else that their frames need, or a path that is not known yet.
std::string NextOf(const Arguments& a, std::span<const lf::Package> packages) {
  const std::string store = lf::FileArgument(a.output);
  if (packages.empty()) return lf::NextRender(lf::ShellCommand({store, "PATH.yaml"}));
  std::vector<std::string> options = {"--lightfield", store};
  const lf::PackageChoices& choices = packages[0].choices;
  if (choices.mode != lf::RenderMode::kCollect)
    options.insert(options.end(), {"--mode", NameOf(choices.mode)});
  if (choices.interpolation == lf::RayInterpolation::kCells)
    options.insert(options.end(), {"--interpolation", NameOf(choices.interpolation)});
  if (!choices.has_neighbours && choices.mode != lf::RenderMode::kRebin)
    options.insert(options.end(), {"--lens-weights", "none"});
  if (!choices.has_neighbours && packages[0].whole_virtual_count > 0)
    options.emplace_back("--no-guard");
  return lf::NextRender(lf::ShellPackages(a.inputs), options);
}

// Returns kUsage if the encoded images of a packed store are copied, and an option says how to
// encode them.
lf::Result<void> CheckCopies(const Arguments& a, const lf::CompressSource& source) {
  if (!source.IsCopied() || a.codec == lf::CodecWords()) return {};
  return lf::UsageError(fmt::format(
      "{}: is a packed store, whose encoded images are copied as they are: leave out --profile, "
      "--threshold, --target-psnr, --levels, --quantizer, --entropy, --reencode and "
      "--quality-by-use, or give "
      "the light field that the store was made from",
      source.light_field.folder.string()));
}

struct Input {
  lf::CompressSource source;
  std::optional<lf::ImageUse> use = {};  // set if --quality-by-use is given
  std::string next;                      // NextOf()
};

// Opens the LF images to compress.
lf::Result<Input> OpenInput(const Arguments& a, const std::atomic<bool>& interrupted,
                            lf::ThreadPool& pool) {
  if (!HasPackages(a)) {
    if (a.inputs.size() > 1)
      return lf::UsageError(
          "a light field and other inputs are given: expected one LIGHTFIELD, or only packages "
          "(files that end in .lfp)");
    if (a.needed_pixels || a.codec.quality_by_use || !a.light_field.path.empty())
      return lf::UsageError(
          "--needed-pixels, --quality-by-use and --lightfield can only be used with packages "
          "(files "
          "that end in .lfp): leave them out");
    lf::LightFieldArgument argument = a.light_field;
    argument.path = a.inputs.front();
    LF_ASSIGN_OR_RETURN(lf::LightField light_field, argument.Open());
    Input input;
    LF_ASSIGN_OR_RETURN(input.source, a.codec.demosaic == "joint"
                                          ? lf::DemosaickedJointly(std::move(light_field))
                                          : lf::SourceOfAll(std::move(light_field)));
    LF_RETURN_IF_ERROR(CheckCopies(a, input.source));
    input.next = NextOf(a, {});
    return input;
  }
  if (a.codec.demosaic == "joint")
    return lf::UsageError(
        "--demosaic joint cannot be used with packages, whose frames are planned for mosaics: make "
        "a store of the whole light field, and packages of that store");
  LF_RETURN_IF_ERROR(a.light_field.CheckWithPackages());
  std::optional<lf::LightField> light_field;
  std::optional<lf::LightFieldPlace> place;
  if (!a.light_field.path.empty()) {
    LF_ASSIGN_OR_RETURN(light_field, a.light_field.Open());
    LF_ASSIGN_OR_RETURN(place, lf::PlaceOf(a.light_field.path, *light_field));
  }
  std::vector<lf::Package> packages;
  for (const std::string& path : a.inputs) {
    LF_ASSIGN_OR_RETURN(lf::Package package, lf::OpenPackage(path, place));
    packages.push_back(std::move(package));
  }
  if (!light_field) {
    LF_ASSIGN_OR_RETURN(light_field, OpenSourceOf(packages.front(), a.inputs.front()));
  }
  Input input;
  LF_ASSIGN_OR_RETURN(input.source,
                      lf::SourceOfPackages(*std::move(light_field), packages, a.needed_pixels));
  LF_RETURN_IF_ERROR(CheckCopies(a, input.source));
  if (a.codec.quality_by_use) {
    LF_ASSIGN_OR_RETURN(input.use, lf::UseBy(packages, pool, &interrupted));
  }
  input.next = NextOf(a, packages);
  return input;
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  LF_ASSIGN_OR_RETURN(lf::CompressOptions options, MakeOptions(a, common));
  lf::ThreadPool pool(common.threads);
  LF_ASSIGN_OR_RETURN(const Input input, OpenInput(a, interrupted, pool));
  if (input.use) options.use = &*input.use;
  options.interrupted = &interrupted;
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "LF images");
  std::optional<lf::CompressPhase> phase;
  LF_ASSIGN_OR_RETURN(
      const lf::CompressReport report,
      lf::Compress(input.source, options, pool, [&](const lf::CompressProgress& now) {
        if (phase != now.phase) meter.Restart(now.done);
        phase = now.phase;
        meter.Update(now.done, now.total, lf::ProgressDetail(now));
      }));
  const lf::Result<void> end = lf::EndWithMissing(
      {report.skipped.size(), report.image_count, lf::MissingText(report, options),
       "once they are mended, encode all LF images again with --overwrite"},
      limit);
  LF_RETURN_IF_ERROR(
      lf::PrintReport(common.json ? lf::CompressJson(report, options)
                                  : lf::CompressText(report, options, end ? input.next : "")));
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfcompressor", kHelp);
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
