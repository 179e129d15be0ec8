// SPDX-License-Identifier: Apache-2.0
// lfimport LIGHTFIELD [-o DIR]: converts any calibration to a transforms.json, and reports on the
// capture.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/next_step.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/core/shell_word.h"
#include "lf/import/agreement/pose_repair.h"
#include "lf/import/check/exclude_images.h"
#include "lf/import/check/native_folder.h"
#include "lf/import/check/similarity.h"
#include "lf/import/check/unused_masks.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/import/report/exposure_steps.h"
#include "lf/import/report/import_report.h"
#include "lf/light_field/model/reduction.h"
#include "lf/storage/load/measure_footprint.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/reference_table.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfimport"),
    .usage = "  lfimport LIGHTFIELD [-o DIR] [OPTIONS]",
    .examples =
        R"(  lfimport capture/                                   # only the report: is it complete?
  lfimport capture/ -o native --exclude 'IMG_01*,IMG_0377.jpg' --scale 0.0213
  lfimport capture/ -o native --exclude missing --transform upright.txt
  lfimport cards/ -o cards --pitch 1 --focal-px 768 --plane-distance 100
  lfimport capture/ -o native --match-exposure --vignetting
  lfimport brackets/ -o hdr --gain-from-exif --mask-clipped
  lfimport capture/ --json --distance 1.5 | jq .density)",
    .details =
        R"(With -o the program writes DIR/transforms.json, which refers to the image files where they are;
images are not copied. If DIR is LIGHTFIELD itself and already contains a transforms.json written by
lfimport, the program reads the calibration from which that file was made. A transforms.json that
lfimport did not write, or that was changed afterwards, is replaced only with --force.

Exit code 6: the report and the file are written, but more images are missing or broken than
--allow-missing accepts. With --strict one such image is an error: the report is printed, but no
file is written. The same happens if all images are missing or broken.
doc/formats/import_report.md describes the report.)",
};

struct Arguments {
  lf::LightFieldArgument light_field;
  std::string output, pitch, transform, bayer, masks, check = "headers";
  double plane_distance = 0, scale = 1, unit_m = 0, distance = 0;
  bool flip_x = false, flip_y = false, is_serpentine = false, force = false;
  std::pair<int, int> grid = {0, 0};
  std::string layout;
  std::string repair;
  std::vector<std::string> exclude;
  lf::AllowMissing allow_missing;
  lf::ExposureSteps exposure;
  std::vector<std::string> call;  // all words of the command line
};

void AddInput(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  lf::OptionGroup input(app, lf::kInputGroup);
  input
      .Add("--exclude NAMES", a.exclude,
           "LF images to leave out: 'IMG_01*,x.jpg' or @FILE\n"
           "NAMES: names of LF images, or patterns (* ? [a-z]), separated by commas; or @FILE, a "
           "file with one name or pattern per line. The word missing stands for all LF images "
           "whose files are missing or broken (--check). The option may be repeated.")
      ->expected(1)
      ->take_all();
  input.Add("--masks DIR", a.masks,
            "Folder of masks of the LF images (as recorded)\n"
            "Pixels that are black in a mask send no ray. The mask of IMAGE.jpg is IMAGE.jpg.png, "
            "IMAGE.png or IMAGE.jpg in DIR, or in a folder below it that the name of the image "
            "contains. LF images without a mask there are used whole.");
  input.Add(
      "--repair WORDS", a.repair,
      "Undo a mistake in poses, focal lengths or names\n"
      "The report names the words if images and poses do not agree. WORDS, separated by "
      "commas:\n"
      "inverse: the matrices were inverted\n"
      "transpose, transpose-opengl, transpose-rotation: the rotations were transposed; with "
      "the positions of the cameras, with those in OpenGL's axes, or with the translations "
      "kept\n"
      "centre, translation: one was written for the other\n"
      "axes:x-y-z: right, down and forward axis of the cameras, in terms of the recorded "
      "axes\n"
      "positions:xz-y: x, y and z of the positions, in terms of the recorded axes\n"
      "mirror-x, mirror-y: the images, or an axis of the world or of a grid, were mirrored; "
      "frames show the scene like the images\n"
      "focal:X or focal:XxY: focal lengths are X times (and Y times, along y) as long\n"
      "swap-principal-point: cx and cy were exchanged\n"
      "names+1, names-1: each image gets the pose recorded for the next name, or for the name "
      "before; the image that gets none is left out\n"
      "names-reversed, names-from-text, names-to-text: images were sorted backwards, as text "
      "(1, 10, 2) or by number (1, 2, 10)");
  input.AddChoice("--bayer", a.bayer, {"RGGB", "BGGR", "GRBG", "GBRG"},
                  "The images are mosaics with this Bayer pattern\n"
                  "The letters are the colours of the upper left 2x2 pixels, row by row. The "
                  "option overrides what the calibration and camera raw files say.");
  input.AddChoice("--check", a.check, {"none", "headers", "pixels"},
                  "How the image files are checked\n"
                  "none: not at all\n"
                  "headers: the header of each file is read\n"
                  "pixels: all pixels are decoded, which is slow");
  a.allow_missing.AddTo(app, "the LF images of the light field");
}

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  output.Add("-o,--output DIR", a.output, "Folder of the transforms.json to write");
  output.AddFlag("--force", a.force,
                 "Replace a transforms.json not written by lfimport\n"
                 "Needed if lfimport did not write the transforms.json in DIR, if the file was "
                 "changed afterwards, or if it is the calibration that is read.");
  output.Add(
      "--transform FILE|MATRIX", a.transform,
      "Rotate, scale and move the world\n"
      "M is a 4x4 matrix that maps old to new world coordinates: a rotation, one scale and a "
      "translation. FILE contains M; MATRIX is the 16 numbers of M, row by row, quoted as one "
      "argument.");
  output.Add("--scale X", a.scale, "Multiply all lengths by X, after --transform")
      ->check(CLI::Range(1e-9, 1e9));
  output
      .Add("--unit-m METRES", a.unit_m,
           "Metres per world unit (as recorded)\n"
           "The unit of the written light field, after --transform and --scale.")
      ->check(CLI::Range(0., 1e9));
  output
      .Add("--distance X", a.distance,
           "Distance to the scene, for the density report (as recorded)\n"
           "In world units. The report tells whether the LF cameras are close enough to each other "
           "for this distance. 0: the distance is taken from the calibration.")
      ->check(CLI::NonNegativeNumber);
}

void AddExposure(CLI::App& app, lf::ExposureSteps& steps) {
  lf::OptionGroup picture(app, lf::kPictureGroup);
  CLI::Option* const option = picture.AddFlag(
      "--match-exposure", steps.match,
      "Make the LF images equally bright\n"
      "Estimates a brightness factor (lf_gain) for each image and colour channel, from parts of "
      "the scene that neighbouring images both show. The factors replace lf_gain in the "
      "transforms.json that -o writes; without -o only their range is reported. See "
      "doc/inputs.md.");
  picture
      .AddFlag("--vignetting", steps.vignetting,
               "Correct the darkening towards the corners\n"
               "In addition to lf_gain, estimates lf_vignetting of each lens: how much darker it "
               "images the corners than the centre.")
      ->needs(option);
  picture
      .AddFlag("--gain-from-exif", steps.gain_from_exif,
               "Take the exposure of each image from its file\n"
               "Computes lf_gain of each image from the exposure time, f-number and ISO "
               "sensitivity in its file (Exif data), relative to the image of median exposure. The "
               "result replaces the lf_gain of LIGHTFIELD.")
      ->excludes(option);
  picture.AddFlag(
      "--mask-clipped", steps.mask_clipped,
      "Merge images of one pose with different exposures\n"
      "Writes \"lf_clipped\": \"mask\" into transforms.json. Renders then take each pixel from the "
      "brightest image of the pose in which it is not clipped (overexposed). Needs the exposures "
      "(lf_gain) of the images, for example by --gain-from-exif.");
}

void AddNamedImages(CLI::App& app, Arguments& a) {
  lf::OptionGroup named(app, "Images named by row and column (doc/formats/stanford.md)");
  named.Add(
      "--pitch P|PX,PY", a.pitch,
      "Distance between LF cameras, in world units\n"
      "P: distance between neighbouring columns and rows; PX,PY: between columns, between rows. "
      "Needed if the names contain no positions; replaces the positions otherwise.");
  named
      .Add("--plane-distance X", a.plane_distance,
           "Depth of the plane without parallax (none)\n"
           "In world units. Needed for rectified images, in which the points of one plane of the "
           "scene are at the same pixels in all images. 0: the images are not rectified; the "
           "cameras look in parallel directions.")
      ->check(CLI::NonNegativeNumber);
  CLI::Option* const grid =
      named
          .Add("--grid COLUMNSxROWS", a.grid,
               "The images are those of a grid, in the order of their names\n"
               "For folders whose names do not tell rows and columns. Numbers in names count by "
               "their value. The first image is that of the upper left LF camera; rows follow each "
               "other.")
          ->delimiter('x')
          ->check(CLI::PositiveNumber)
          ->default_str("");
  named.AddChoice("--layout", a.layout, {"mosaic", "quilt", "lenslets"},
                  "How one picture holds the views of --grid (by its name)\n"
                  "mosaic: side by side, row by row from the upper left view on; the default for "
                  "names that do not tell\n"
                  "quilt: the views of one row of LF cameras, from the lower left place on, row by "
                  "row upwards; the default for NAME_qsCxR.png\n"
                  "lenslets: the pixels of all views interleaved; the default for NAME_eslf.png, "
                  "with 14x14 views");
  named
      .AddFlag("--serpentine", a.is_serpentine,
               "Every second row of --grid runs from right to left")
      ->needs(grid);
  named.AddFlag("--flip-x", a.flip_x, "Image names count columns from right to left");
  named.AddFlag("--flip-y", a.flip_y, "Image names count rows from bottom to top");
}

void AddOptions(CLI::App& app, Arguments& a) {
  AddInput(app, a);
  AddOutput(app, a);
  AddExposure(app, a.exposure);
  AddNamedImages(app, a);
}

// Parses the value of --pitch: P or PX,PY.
lf::Result<lf::Vec2> ParsePitch(const std::string& text) {
  const std::string_view words = text;
  const size_t comma = words.find(',');
  const auto x = lf::ParseNumber(words.substr(0, comma));
  const auto y = comma == std::string::npos ? x : lf::ParseNumber(words.substr(comma + 1));
  if (x && y) return lf::Vec2(*x, *y);
  return lf::UsageError(fmt::format(
      "--pitch {}: expected P or PX,PY, numbers in world units, such as 0.5 or 0.5,0.4", text));
}

// Returns true if lfimport reads and writes the same folder, which holds both a transforms.json
// that an earlier lfimport wrote and the calibration that this file was made from.
bool WritesAgain(const Arguments& a) {
  std::error_code error;
  return !a.output.empty() && std::filesystem::equivalent(a.light_field.path, a.output, error) &&
         lf::HoldsOwnAndItsSource(a.light_field.path, a.grid.first > 0);
}

// Returns the command of this call with options added, and with -o, if the call does not have it.
std::string ImportAgain(const Arguments& a, const std::vector<std::string>& added,
                        const std::string& output) {
  std::vector<std::string> words = added;
  if (a.output.empty()) words.insert(words.end(), {"-o", lf::FileArgument(output)});
  return lf::SameCall(a.call, words);
}

lf::Result<lf::OpenOptions> MakeOpenOptions(const Arguments& a) {
  LF_ASSIGN_OR_RETURN(lf::OpenOptions options, a.light_field.Options());
  if (!a.pitch.empty()) {
    LF_ASSIGN_OR_RETURN(options.pitch_w, ParsePitch(a.pitch));
  }
  if (a.grid.first > 0) options.grid = {a.grid.first, a.grid.second};
  options.is_serpentine = a.is_serpentine;
  options.layout = lf::PictureLayoutOf(a.layout);
  if (a.plane_distance > 0) options.plane_distance_w = a.plane_distance;
  options.flip_x = a.flip_x;
  options.flip_y = a.flip_y;
  options.passes_over_own = WritesAgain(a);
  options.bayer = lf::BayerPatternOf(a.bayer);
  if (!a.masks.empty()) options.masks_folder = a.masks;
  options.call_again = lf::CallOfProgram();
  // The transforms.json refers to the frames, which therefore lie beside it, and not in a cache.
  if (!a.output.empty() && !options.frame_cache)
    options.frame_cache = std::filesystem::path(a.output) / "frames";
  options.import_again = [&a](const std::vector<std::string>& added) {
    // The folder for the calibration of a picture of many views has the name of the picture.
    std::error_code error;
    std::filesystem::path output = a.light_field.path;
    if (std::filesystem::is_regular_file(output, error)) output.replace_extension();
    return ImportAgain(a, added, output.string());
  };
  return options;
}

// Returns the patterns of --exclude but for the word that stands for missing LF images, and whether
// it is among them.
lf::Result<std::pair<std::vector<std::string>, bool>> ReadExcluded(const Arguments& a) {
  LF_ASSIGN_OR_RETURN(std::vector<std::string> patterns, lf::ReadPatterns(a.exclude));
  const bool excludes_missing = std::erase(patterns, lf::kMissingPattern) > 0;
  if (excludes_missing && a.check == "none")
    return lf::UsageError(
        fmt::format("--exclude {} cannot be used with --check none, which does not look for the "
                    "files: leave one of the two out",
                    lf::kMissingPattern));
  return std::pair(std::move(patterns), excludes_missing);
}

// Opens the light field and applies --repair, the patterns of --exclude, --transform, --scale and
// --unit-m. Sets the number of LF images that --repair leaves without a pose or --exclude names.
lf::Result<lf::LightField> OpenChanged(const Arguments& a, const std::vector<std::string>& patterns,
                                       size_t* excluded_count) {
  LF_ASSIGN_OR_RETURN(const lf::OpenOptions options, MakeOpenOptions(a));
  LF_ASSIGN_OR_RETURN(const lf::Repair repair, lf::ParseRepair(a.repair));
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, lf::OpenLightField(a.light_field.path, options));
  *excluded_count = lf::ApplyRepair(repair, &light_field);
  LF_ASSIGN_OR_RETURN(const size_t excluded, lf::ExcludeImages(patterns, &light_field));
  *excluded_count += excluded;
  LF_ASSIGN_OR_RETURN(const lf::Similarity similarity, lf::ReadSimilarity(a.transform, a.scale));
  if (!a.transform.empty() || a.scale != 1)
    LF_RETURN_IF_ERROR(lf::Transform(similarity, &light_field));
  constexpr double kLeastUnit_m = 1e-9;
  if (a.unit_m > 0 && a.unit_m < kLeastUnit_m)
    return lf::UsageError(
        fmt::format("--unit-m {}: expected metres per world unit from 1e-9 to 1e9", a.unit_m));
  if (a.unit_m > 0) light_field.unit_m = a.unit_m;
  return light_field;
}

// Returns the footprint of LF pixels: as the calibration states it, otherwise as measured. If it is
// points, sets encoding.footprint, so that the written transforms.json states it. Measured areas
// are not stated; programs measure them again.
lf::Result<lf::FootprintFacts> FindFootprint(lf::LightField* light_field) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<lf::LfImageStore> store,
                      lf::OpenStore(*light_field, lf::Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(const lf::PixelFootprint found, lf::FootprintOf(*light_field, *store));
  const bool is_stated = light_field->encoding.footprint.has_value();
  if (found == lf::PixelFootprint::kPoint) light_field->encoding.footprint = found;
  return lf::FootprintFacts{found, is_stated};
}

lf::Result<lf::ImageFaults> CheckFiles(const Arguments& a, const lf::CommonOptions& common,
                                       const lf::LightField& light_field,
                                       const std::atomic<bool>& interrupted, lf::ThreadPool& pool) {
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "images");
  lf::CheckOptions check;
  check.check = a.check == "pixels" ? lf::ImageCheck::kPixels : lf::ImageCheck::kHeaders;
  check.interrupted = &interrupted;
  check.progress = [&](size_t done, size_t total) { meter.Update(done, total, "checking"); };
  return lf::CheckImages(lf::RecordedLightField(light_field), check, pool);
}

void WarnOfMasks(const Arguments& a, const lf::LightField& light_field, lf::ImportReport* report) {
  if (!a.masks.empty()) return;
  const auto again = [&a](const std::vector<std::string>& added) {
    return ImportAgain(a, added, "masked");
  };
  if (std::optional<lf::CaptureWarning> warning = lf::WarnOfUnusedMasks(light_field, again))
    report->capture.warnings.push_back(*std::move(warning));
}

// Returns the advice of a call that found missing or broken LF images.
std::string AdviceOnFaults(const Arguments& a, const lf::LightField& light_field) {
  if (lf::HoldsPackedStore(light_field))
    return "renders leave them out, too; --exclude removes them from the light field";
  return "renders leave them out, too, and end with the same exit code; to write a calibration "
         "without them: " +
         ImportAgain(a, {fmt::format("--exclude={}", lf::kMissingPattern)},
                     lf::FreeName("complete", ""));
}

// Returns true if the call only reports, so that other programs see the light field as it does.
bool OnlyReports(const Arguments& a) {
  return a.output.empty() && a.pitch.empty() && a.grid.first == 0 && a.layout.empty() &&
         a.plane_distance == 0 && !a.flip_x && !a.flip_y && a.transform.empty() && a.scale == 1 &&
         a.unit_m == 0 && a.bayer.empty() && a.masks.empty() && a.repair.empty() &&
         a.exclude.empty() && !a.exposure.match && !a.exposure.gain_from_exif &&
         !a.exposure.mask_clipped;
}

// Returns the line that advises to make a path; "" if images and poses do not agree, if a path
// needs more positions, or if no file holds what is reported.
std::string NextOf(const Arguments& a, const lf::ImportReport& report) {
  if (!report.capture.spacing_w || !(report.capture.spacing_w->median > 0)) return "";
  for (const lf::CaptureWarning& warning : report.capture.warnings)
    if (warning.kind == "poses-disagree") return "";
  std::vector<std::string> words = {"lfexample"};
  if (!report.written.empty()) {
    words.push_back(lf::FileArgument(a.output));
  } else if (OnlyReports(a)) {
    words.push_back(lf::FileArgument(a.light_field.path));
    for (const std::string& word : a.light_field.Words()) words.push_back(word);
  } else {
    return "";
  }
  words.insert(words.end(), {"-o", lf::FreeName("path", ".yaml")});
  return fmt::format("next: {}\n", lf::ShellCommand(words));
}

lf::Result<void> Import(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  if (!a.output.empty())
    LF_RETURN_IF_ERROR(
        lf::CheckMayWrite(WritesAgain(a) ? "" : a.light_field.path, a.output, a.force));
  lf::ImportReport report;
  report.light_field = a.light_field.path;
  LF_ASSIGN_OR_RETURN(const auto excluded, ReadExcluded(a));
  const auto& [patterns, excludes_missing] = excluded;
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, OpenChanged(a, patterns, &report.excluded_count));
  report.video = light_field.video;
  report.shown_times = light_field.slice_times;
  if (!a.output.empty()) LF_RETURN_IF_ERROR(lf::CheckNames(a.output, light_field));
  lf::ThreadPool pool(common.threads);
  if (lf::HoldsPackedStore(light_field)) {
    LF_ASSIGN_OR_RETURN(report.films, lf::ReadStoreFilms(light_field.folder));
    LF_ASSIGN_OR_RETURN(const lf::ReferenceTable references,
                        lf::ReadReferences(light_field.folder));
    report.predicted_count = references.predicted_count();
  }
  if (a.check != "none") {
    LF_ASSIGN_OR_RETURN(report.faults, CheckFiles(a, common, light_field, interrupted, pool));
    if (excludes_missing) {
      LF_ASSIGN_OR_RETURN(const size_t count, lf::ExcludeFaulty(*report.faults, &light_field));
      report.excluded_count += count;
      report.faults->missing.clear();
      report.faults->broken.clear();
    }
  }
  report.first_image = light_field.ImagePath({0}).lexically_normal().string();
  lf::CaptureReportOptions options;
  if (a.distance > 0) options.distance_w = a.distance;
  options.import_again = [&a](const std::vector<std::string>& added) {
    return ImportAgain(a, added, "merged");
  };
  LF_ASSIGN_OR_RETURN(report.exif_gains,
                      lf::StateBrackets(a.exposure, pool, &light_field, &options.lights));
  report.capture = lf::ReportCapture(light_field, options, pool);
  WarnOfMasks(a, light_field, &report);
  size_t fault_count = 0;
  if (report.faults) {
    lf::WarnOfFaults(light_field, &report);
    fault_count = report.faults->missing.size() + report.faults->broken.size();
  }
  if (interrupted)
    return lf::Error{lf::ErrorKind::kInterrupted, "interrupted before anything was written"};
  const bool refuses = fault_count == light_field.size() || (common.strict && fault_count > 0);
  if (a.exposure.match && !refuses) {
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "images");
    const auto progress = [&](size_t done, size_t total) {
      meter.Update(done, total, "matching exposure");
    };
    LF_ASSIGN_OR_RETURN(report.exposure, lf::MatchAndApply(a.exposure, interrupted, progress, pool,
                                                           &light_field, &report.capture));
  }
  lf::WarnOfBrackets(a.exposure, report.exif_gains, &light_field, &report.capture);
  if (report.faults) report.profile = lf::FindProfile(light_field);
  if (report.faults && !refuses) {
    const auto repair_call = [&](const std::string& words) -> std::string {
      // A repair of poses that were repaired before cannot be added to that call, and a packed
      // store keeps the poses that it was made with.
      if (!a.repair.empty() || lf::HoldsPackedStore(light_field)) return "";
      return ImportAgain(a, {"--repair", words}, "repaired");
    };
    LF_RETURN_IF_ERROR(lf::JudgePoses(light_field, pool, interrupted, repair_call, &report));
    LF_ASSIGN_OR_RETURN(report.pixels, FindFootprint(&light_field));
  }
  if (!a.output.empty() && !refuses) {
    LF_ASSIGN_OR_RETURN(report.written, lf::WriteNativeFolder(a.output, &light_field));
  }
  if (!refuses) report.next = NextOf(a, report);
  LF_RETURN_IF_ERROR(
      lf::PrintReport(common.json ? lf::ReportJson(report) : lf::ReportText(report)));
  if (fault_count == 0) return {};
  const std::string what =
      fmt::format("{} of {} images are missing, {} broken", report.faults->missing.size(),
                  light_field.size(), report.faults->broken.size());
  if (refuses) return lf::InputError(what + "; nothing was written");
  return lf::EndWithMissing({fault_count, light_field.size(), what, AdviceOnFaults(a, light_field)},
                            limit);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.call.assign(argv, argv + argc);
  lf::Program program("lfimport", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .strict = "Write no file if an LF image is missing or broken\n"
                                      "The report is printed; the exit code is 3.",
                            .json = "Print the report to stdout as JSON, with all digits",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Import(arguments, program.common()); });
}
