// SPDX-License-Identifier: Apache-2.0
// lfcompare REFERENCE TEST: measures how far pictures are from references.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"

#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/film/compare/compare_pictures.h"
#include "lf/film/compare/compare_report.h"
#include "lf/film/compare/difference_picture.h"
#include "lf/film/compare/picture_light.h"
#include "lf/film/compare/picture_pairs.h"
#include "lf/pixels/files/image_file.h"

namespace {
namespace fs = std::filesystem;

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfcompare"),
    .usage = "  lfcompare REFERENCE TEST [OPTIONS]",
    .examples = R"(  lfcompare truth.exr frame_0001.exr
  lfcompare reference/ frames/ -o differences         # all frames, and where they differ
  lfcompare photo.jpg frame.png --border 8 --json
  lfcompare reference/ frames/ --min-psnr 40          # exit code 6 if a frame falls below)",
    .details =
        R"(REFERENCE and TEST are two pictures (PNG, JPEG, TIFF, EXR), or two folders whose pictures have equal
names; contact sheets are left out. Integers are sRGB values, EXR files linear light in the primaries
that they state. Transparent pictures are composited over black.

PSNR       peak signal-to-noise ratio of sRGB values in dB, clipped to black and white; higher is better
linear     PSNR of linear light, not clipped
SSIM       structural similarity of brightness, 1 if equal (Wang et al. 2004); the windows at the border
           repeat its pixels
FLIP       difference that a person sees who alternates between the pictures, from 0 to 1 (Andersson
           et al. 2020)

The line "all" has the PSNR of all pixels together, and the means of SSIM and FLIP over them.)",
};

struct Arguments {
  std::string reference, test, output, show = "flip";
  double gain = 8, min_coverage = 0, pixels_per_degree = lf::kPixelsPerDegree;
  int border = 0;
  bool common = false, overwrite = false;
  lf::CompareLimits limits;
};

void AddOptions(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup), output(app, lf::kOutputGroup);
  lf::OptionGroup quality(app, lf::kQualityGroup);
  input.Add("REFERENCE", a.reference, "Reference picture, or folder of such pictures")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles("image folder"));
  input.Add("TEST", a.test, "Picture, or folder of pictures, that is judged")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles("image folder"));
  input.AddFlag("--common", a.common,
                "Compare only the names that both folders have\n"
                "Without this option a picture that one of them lacks is an error.");
  output
      .Add("-o,--output OUT", a.output,
           "Pictures of the differences: NAME.png, or, for folders, a folder\n"
           "The folder is made if it does not exist.")
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".png folder"));
  output.AddChoice("--show", a.show, {"flip", "difference"},
                   "What the pictures of --output show\n"
                   "flip: FLIP, from black (no difference) over violet and orange to yellow\n"
                   "difference: grey where equal, brighter where TEST is brighter, in sRGB values");
  output
      .Add("--gain X", a.gain,
           "Factor of the differences (with --show difference)\n"
           "With 8, a difference of 16 of 255 is shown as one of 64.")
      ->check(CLI::PositiveNumber);
  output.AddFlag("--overwrite", a.overwrite, "Replace the files that exist");
  quality.Add("--border N", a.border, "Pixels at each side that do not count")
      ->check(CLI::Range(0, 1 << 20));
  quality
      .Add(
          "--coverage SHARE", a.min_coverage,
          "Least coverage of pixels that count\n"
          "Frames in EXR files have a channel for it: the share of the lens that LF images filled. "
          "Pixels count where both pictures have at least this coverage, or no such channel.")
      ->check(CLI::Range(0.0, 1.0));
  quality
      .Add("--pixels-per-degree N", a.pixels_per_degree,
           "Distance of the observer, for FLIP\n"
           "Pixels per degree of the visual angle. By default a display with 3840 columns is seen "
           "from as far as it is wide.")
      ->check(CLI::Range(1.0, 10000.0));
  quality.Add("--min-psnr DB", a.limits.min_psnr_db,
              "PSNR that every picture must have, otherwise exit code 6");
  quality.Add("--min-ssim X", a.limits.min_ssim,
              "SSIM that every picture must have, otherwise exit code 6");
  quality.Add("--max-flip X", a.limits.max_flip,
              "FLIP that no picture may exceed, otherwise exit code 6");
}

// The pictures of the differences of all pairs.
struct Outputs {
  std::vector<fs::path> files;       // one for each pair; empty if none is wanted
  std::optional<lf::FileLock> lock;  // held if the files are written into a folder
};

lf::Result<std::vector<fs::path>> FilesOf(const Arguments& a,
                                          const std::vector<lf::PicturePair>& pairs) {
  std::vector<fs::path> files, inputs;
  if (a.output.empty()) return files;
  std::error_code error;
  const fs::path out = a.output;
  const bool is_film = pairs.front().reference != a.reference;  // true if two folders are compared
  if (!is_film && out.extension() != ".png")
    return lf::UsageError(
        fmt::format("-o {}: its extension is \"{}\": expected a name that ends in .png", a.output,
                    out.extension().string()));
  if (const fs::file_status status = fs::status(out, error); status.type() == fs::file_type::none)
    return lf::OutputError(
        fmt::format("-o {}: cannot be looked at: {}", a.output, error.message()));
  if (is_film && fs::exists(out, error) && !fs::is_directory(out, error))
    return lf::UsageError(
        fmt::format("-o {}: is a file: expected a folder for the pictures of the differences of {} "
                    "pairs",
                    a.output, pairs.size()));
  for (const lf::PicturePair& pair : pairs) {
    files.push_back(is_film ? out / (pair.name + ".png") : out);
    inputs.insert(inputs.end(), {pair.reference, pair.test});
  }
  // The folders that are compared would gain pictures of differences, which the next call compares.
  for (const std::string& folder : {a.reference, a.test})
    if (is_film && lf::LiesIn(out, folder) && lf::LiesIn(folder, out))
      return lf::UsageError(fmt::format("-o {}: is a folder that is compared ({}): give another -o",
                                        a.output, folder));
  // Inputs come first, because --overwrite does not replace them.
  LF_RETURN_IF_ERROR(lf::CheckOutputFiles({files.begin(), files.end()}, inputs));
  for (const fs::path& file : files)
    if (!a.overwrite && fs::exists(file, error))
      return lf::UsageError(fmt::format(
          "{}: exists: give another name, or replace it with --overwrite", file.string()));
  return files;
}

lf::Result<Outputs> OutputsOf(const Arguments& a, const std::vector<lf::PicturePair>& pairs) {
  Outputs outputs;
  LF_ASSIGN_OR_RETURN(outputs.files, FilesOf(a, pairs));
  std::error_code error;
  if (outputs.files.empty() || !fs::is_directory(a.reference, error)) return outputs;
  LF_ASSIGN_OR_RETURN(outputs.lock, lf::LockOutputFolder(a.output));
  LF_RETURN_IF_ERROR(FilesOf(a, pairs));  // another call may have ended just now
  return outputs;
}

lf::Error WithName(const std::string& name, lf::Error error) {
  error.message = name + ": " + error.message;
  return error;
}

// Compares one pair, and writes the picture of its differences if `out` is given.
lf::Result<lf::ComparedPair> ComparePair(const Arguments& a, const lf::PicturePair& pair,
                                         const fs::path* out, lf::ThreadPool& pool) {
  LF_ASSIGN_OR_RETURN(const lf::PictureLight reference, lf::ReadPictureLight(pair.reference));
  LF_ASSIGN_OR_RETURN(const lf::PictureLight test, lf::ReadPictureLight(pair.test));
  const lf::CompareOptions options = {
      .border = a.border, .min_coverage = a.min_coverage, .pixels_per_degree = a.pixels_per_degree};
  const auto comparison = lf::ComparePictures(reference, test, options, pool);
  if (!comparison) return WithName(pair.test.string(), comparison.error());
  lf::ComparedPair compared = {.pair = pair,
                               .width = test.rgb.width(),
                               .height = test.rgb.height(),
                               .difference = comparison->difference};
  if (out == nullptr) return compared;
  const lf::Image<uint8_t> picture = a.show == "flip"
                                         ? lf::FlipPicture(comparison->flip)
                                         : lf::SignedDifferencePicture(reference, test, a.gain);
  LF_RETURN_IF_ERROR(lf::WriteImage(*out, picture.view()));
  compared.picture = *out;
  return compared;
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& is_interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const auto pairs, lf::FindPicturePairs(a.reference, a.test, a.common));
  LF_ASSIGN_OR_RETURN(const Outputs outputs, OutputsOf(a, pairs));
  lf::ThreadPool pool(common.threads);
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "pictures");
  std::vector<lf::ComparedPair> compared;
  for (const lf::PicturePair& pair : pairs) {
    if (is_interrupted)
      return lf::Error{lf::ErrorKind::kInterrupted,
                       fmt::format("interrupted after {} of {} pictures; nothing is reported, and "
                                   "pictures of differences that were written stay",
                                   compared.size(), pairs.size())};
    const fs::path* const out = outputs.files.empty() ? nullptr : &outputs.files[compared.size()];
    LF_ASSIGN_OR_RETURN(lf::ComparedPair one, ComparePair(a, pair, out, pool));
    compared.push_back(std::move(one));
    meter.Update(compared.size(), pairs.size(), "");
  }
  LF_RETURN_IF_ERROR(
      lf::PrintReport(common.json ? lf::CompareJson(compared) : lf::CompareTable(compared)));
  return lf::CheckLimits(compared, a.limits);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfcompare", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions(
      {.threads = true, .json = "Print the report as JSON", .progress = true, .quiet = true});
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
