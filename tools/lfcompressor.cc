// lfcompressor LIGHTFIELD|PACKAGE... -o STORE.lfs: compresses a light field into one file.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/byte_size.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/compress_report.h"

#include "lf/compress/compress.h"
#include "lf/package/package_file.h"
#include "lf/packed/packed_store_file.h"
#include "lf/pipeline/render_packages.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfcompressor capture/ -o capture.lfs                        # about 45 dB
  lfcompressor capture/ -o capture.lfs --profile lossless     # every bit
  lfcompressor capture/ -o capture.lfs --target-psnr 42 --verify
  lfcompressor packages/package-*.lfp -o film.lfs             # what a film needs, and no more
  lfrenderer capture.lfs path.yaml -o frames                  # a store is a LIGHTFIELD
  lfrenderer packages/package-0000.lfp --lightfield film.lfs -o frames

STORE.lfs holds the LF images, coded one by one, and their calibration: one file that every program
takes as LIGHTFIELD (doc/formats/packed_store.md). Until it is whole it is STORE.lfs.unfinished: Ctrl-C,
kill -9 or a crash lose two seconds of work, and --resume goes on.

LF images that are missing or broken have no code, and the exit code is then 6. --resume tries them again
while the store is unfinished; a store that is finished is made anew by --overwrite.)";

struct Arguments {
  std::vector<std::string> inputs;
  lf::LightFieldArgument light_field;
  std::string output, profile = "default", quantizer = "8bit", shard_size;
  int levels = 0;
  double threshold = -1, target_psnr = 0;
  bool needed_pixels = false, resume = false, overwrite = false, verify = false;
  lf::AllowMissing allow_missing;
};

void AddOptions(CLI::App& app, Arguments& a) {
  app.add_option("INPUT", a.inputs,
                 "LIGHTFIELD: a folder or file of any supported kind; or PACKAGE...: files of "
                 "lfpreprocessor")
      ->required()
      ->check(lf::NotEmpty())
      ->type_name("LIGHTFIELD | PACKAGE...");
  a.light_field.AddOptionsTo(app);
  app.add_option("--lightfield", a.light_field.path, "With packages: where their LF images are now")
      ->check(lf::NotEmpty());
  app.add_option("-o,--output", a.output, "STORE.lfs to write")->required()->check(lf::NotEmpty());
  app.add_option("--profile", a.profile,
                 "default: wavelets and dead-zone quantisers; thesis: Haar, one threshold, one "
                 "range; lossless: every bit")
      ->check(CLI::IsMember({"default", "thesis", "lossless"}));
  app.add_option("--levels", a.levels, "Of the wavelet transform; 0: 4, of the thesis's 1")
      ->check(CLI::Range(0, 5));
  auto* threshold =
      app.add_option("--threshold", a.threshold,
                     "Details below this are dropped, in steps of 256 greys; unless given 3, of "
                     "the thesis's 8")
          ->check(CLI::Range(0., 255.));
  app.add_option("--quantizer", a.quantizer,
                 "With --profile thesis: values that a coefficient may have; 8bit: 256, a byte "
                 "each; above, two bytes");
  app.add_option("--target-psnr", a.target_psnr,
                 "dB that decoded LF images shall have: finds the threshold")
      ->check(CLI::Range(10., 90.))
      ->excludes(threshold);
  app.add_flag("--needed-pixels", a.needed_pixels,
               "With packages: of each LF image only the bounds of the pixels that they take");
  app.add_option("--shard-size", a.shard_size,
                 "Codes in files of about this size beside STORE.lfs, such as 4G")
      ->check(lf::NotEmpty());
  auto* resume =
      app.add_flag("--resume", a.resume,
                   "Go on with an unfinished store of the same LF images, options and files");
  app.add_flag("--overwrite", a.overwrite, "Replace a store that is there, but no other file")
      ->excludes(resume);
  app.add_flag(
      "--verify", a.verify,
      "Compare the calibration, read all codes back, compare and decode them; a store that "
      "is there is checked alone");
  a.allow_missing.AddTo(app, "those to be coded");
}

bool HasPackages(const Arguments& a) {
  return std::all_of(a.inputs.begin(), a.inputs.end(), lf::IsPackageName);
}

lf::Result<lf::CompressOptions> MakeOptions(const Arguments& a, const lf::CommonOptions& common) {
  lf::CompressOptions options;
  options.store = a.output;
  if (options.store.extension() != lf::kStoreExtension)
    return lf::UsageError(
        fmt::format("-o {}: expected a name that ends in {}", a.output, lf::kStoreExtension));
  const bool is_thesis = a.profile == "thesis", is_lossless = a.profile == "lossless";
  options.codec.profile = is_thesis     ? lf::CodecProfile::kThesis
                          : is_lossless ? lf::CodecProfile::kLossless
                                        : lf::CodecProfile::kDefault;
  options.codec.levels = a.levels > 0 ? a.levels : is_thesis ? 1 : 4;
  options.codec.threshold = a.threshold >= 0 ? a.threshold : is_thesis ? 8 : 3;
  if (is_lossless && (a.threshold >= 0 || a.target_psnr > 0))
    return lf::UsageError("--profile lossless drops nothing: no --threshold, no --target-psnr");
  if (a.quantizer != "8bit") {
    if (!is_thesis) return lf::UsageError("--quantizer belongs to --profile thesis");
    if (!CLI::detail::lexical_cast(a.quantizer, options.codec.quantizer))
      return lf::UsageError(
          fmt::format("--quantizer {}: expected 8bit, or 2 to 65536", a.quantizer));
  }
  if (a.target_psnr > 0) options.target_psnr_db = a.target_psnr;
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

lf::Result<lf::CompressSource> OpenSource(const Arguments& a) {
  if (!HasPackages(a)) {
    if (a.inputs.size() > 1)
      return lf::UsageError("expected one LIGHTFIELD, or packages: files that end in .lfp");
    if (a.needed_pixels || !a.light_field.path.empty())
      return lf::UsageError("--needed-pixels and --lightfield are for packages");
    lf::LightFieldArgument argument = a.light_field;
    argument.path = a.inputs.front();
    LF_ASSIGN_OR_RETURN(lf::LightField light_field, argument.Open());
    return lf::SourceOfAll(std::move(light_field));
  }
  LF_RETURN_IF_ERROR(a.light_field.CheckWithPackages());
  std::optional<lf::LightFieldPlace> place;
  if (!a.light_field.path.empty()) {
    LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.Open());
    LF_ASSIGN_OR_RETURN(place, lf::PlaceOf(a.light_field.path, light_field));
  }
  std::vector<lf::Package> packages;
  for (const std::string& path : a.inputs) {
    LF_ASSIGN_OR_RETURN(lf::Package package, lf::OpenPackage(path, place));
    packages.push_back(std::move(package));
  }
  return lf::SourceOfPackages(packages, a.needed_pixels);
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  LF_ASSIGN_OR_RETURN(lf::CompressOptions options, MakeOptions(a, common));
  LF_ASSIGN_OR_RETURN(const lf::CompressSource source, OpenSource(a));
  options.interrupted = &interrupted;
  lf::ThreadPool pool(common.threads);
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "LF images");
  LF_ASSIGN_OR_RETURN(const lf::CompressReport report,
                      lf::Compress(source, options, pool, [&](const lf::CompressProgress& now) {
                        meter.Update(now.done, now.total, lf::ProgressDetail(now));
                      }));
  LF_RETURN_IF_ERROR(lf::PrintReport(common.json ? lf::CompressJson(report, options)
                                                 : lf::CompressText(report, options)));
  return lf::EndWithMissing(lf::MissingOf(report, options), limit);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfcompressor",
                      "Codes the LF images of a light field, or what packages need of it, into a "
                      "packed store.",
                      kExamples);
  program.AddCommonOptions({.threads = true,
                            .strict = "An LF image that cannot be read is an error, not left out",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  AddOptions(program.app(), arguments);
  program.AddJsonOption("The report as JSON");
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
