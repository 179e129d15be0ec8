// lfimport LIGHTFIELD [-o DIR]: converts any calibration to the native one, and reports on it.
#include <filesystem>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/import_exposure.h"
#include "tools/import_report.h"

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/exclude_images.h"
#include "lf/import/native_folder.h"
#include "lf/import/similarity.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfimport capture/                                   only the report: what is it, is it complete?
  lfimport capture/ -o native --exclude 'IMG_01*,IMG_0377.jpg' --scale 0.0213
  lfimport capture/ -o native --exclude @bad.txt --transform upright.txt
  lfimport cards/ -o cards --pitch 1 --focal-px 768 --plane-distance 100
  lfimport capture/ -o native --match-exposure --vignetting
  lfimport brackets/ -o hdr --gain-from-exif --mask-clipped
  lfimport capture/ --json --distance 1.5 | jq .density

Writes DIR/transforms.json, which names the images where they lie; nothing is copied. Where DIR is
LIGHTFIELD itself and has such a file already, what that was made from is read again. A
transforms.json that lfimport did not write, or that was changed since, is replaced only with
--force. Exit code 6: done, but more images are missing or broken than --allow-missing accepts; with
--strict one is an error, and nothing is written. The report: doc/formats/import_report.md.)";

struct Arguments {
  lf::LightFieldArgument light_field;
  std::string output, pitch, transform, bayer, check = "headers";
  double plane_distance = 0, scale = 1, unit_m = 0, distance = 0;
  bool flip_x = false, flip_y = false, force = false;
  std::vector<std::string> exclude;
  lf::AllowMissing allow_missing;
  lf::ExposureArguments exposure;
};

void AddOptions(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  app.add_option("-o,--output", a.output, "Folder of the transforms.json to write");
  app.add_flag("--force", a.force, "Replace a transforms.json that lfimport did not write");
  app.add_option("--exclude", a.exclude,
                 "Images to leave out: names or patterns (* ? [a-z]), with commas between, or "
                 "@FILE with one per line; may be repeated")
      ->expected(1)
      ->take_all();
  app.add_option("--transform", a.transform,
                 "Move the world: FILE with a 4x4 matrix, or its 16 numbers in one word; new = M * "
                 "old, M a rotation, one scale and a translation");
  app.add_option("--scale", a.scale, "Multiply all lengths by this, after --transform")
      ->check(CLI::Range(1e-9, 1e9));
  app.add_option("--unit-m", a.unit_m,
                 "Metres per world unit, as they are then; 0: as the light field says")
      ->check(CLI::Range(0., 1e9));
  app.add_option("--bayer", a.bayer,
                 "The images are mosaics of this pattern, whatever the calibration or camera raw "
                 "files say: the upper left 2x2 pixels row by row")
      ->check(CLI::IsMember({"RGGB", "BGGR", "GRBG", "GBRG"}));
  app.add_option("--check", a.check, "How to check the images: none, headers or pixels (slow)")
      ->check(CLI::IsMember({"none", "headers", "pixels"}));
  a.allow_missing.AddTo(app, "those of the light field");
  app.add_option("--distance", a.distance,
                 "Distance to the scene in world units, for the density; 0: from the calibration")
      ->check(CLI::NonNegativeNumber);
  a.exposure.AddTo(app);
  const char* group = "Images named by row and column (doc/formats/stanford.md)";
  app.add_option("--pitch", a.pitch, "World units between columns and rows: P, or PX,PY")
      ->group(group);
  app.add_option("--plane-distance", a.plane_distance,
                 "Depth of the plane that stands still in all images of a rectified slab; 0: "
                 "the cameras are parallel")
      ->check(CLI::NonNegativeNumber)
      ->group(group);
  app.add_flag("--flip-x", a.flip_x, "Columns count to the left")->group(group);
  app.add_flag("--flip-y", a.flip_y, "Rows count upwards")->group(group);
}

// Parses P or PX,PY.
lf::Result<lf::Vec2> ParsePitch(const std::string& text) {
  lf::Vec2 pitch;
  int end_of_one = -1, end_of_two = -1;
  std::sscanf(text.c_str(), "%lf%n,%lf%n", &pitch.x(), &end_of_one, &pitch.y(), &end_of_two);
  const int size = static_cast<int>(text.size());
  if (end_of_one == size) return lf::Vec2(pitch.x(), pitch.x());
  if (end_of_two == size) return pitch;
  return lf::UsageError(fmt::format("--pitch {}: expected P or PX,PY", text));
}

// Returns true if the folder that is read holds the transforms.json that is written, and the
// calibration that it was made from.
bool WritesAgain(const Arguments& a) {
  std::error_code error;
  return !a.output.empty() && std::filesystem::equivalent(a.light_field.path, a.output, error) &&
         lf::HoldsOwnAndItsSource(a.light_field.path);
}

lf::Result<lf::OpenOptions> MakeOpenOptions(const Arguments& a) {
  LF_ASSIGN_OR_RETURN(lf::OpenOptions options, a.light_field.Options());
  if (!a.pitch.empty()) {
    LF_ASSIGN_OR_RETURN(options.pitch_w, ParsePitch(a.pitch));
  }
  if (a.plane_distance > 0) options.plane_distance_w = a.plane_distance;
  options.flip_x = a.flip_x;
  options.flip_y = a.flip_y;
  options.passes_over_own = WritesAgain(a);
  options.bayer = lf::BayerPatternOf(a.bayer);
  return options;
}

// Returns the light field as it is to be written. Reports which images were excluded.
lf::Result<lf::LightField> OpenChanged(const Arguments& a, size_t* excluded_count) {
  LF_ASSIGN_OR_RETURN(const lf::OpenOptions options, MakeOpenOptions(a));
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, lf::OpenLightField(a.light_field.path, options));
  LF_ASSIGN_OR_RETURN(const std::vector<std::string> patterns, lf::ReadPatterns(a.exclude));
  LF_ASSIGN_OR_RETURN(*excluded_count, lf::ExcludeImages(patterns, &light_field));
  lf::Similarity similarity;
  if (!a.transform.empty()) {
    LF_ASSIGN_OR_RETURN(similarity, lf::ReadSimilarity(a.transform));
  }
  similarity.scale *= a.scale;
  similarity.translation *= a.scale;
  if (!a.transform.empty() || a.scale != 1)
    LF_RETURN_IF_ERROR(lf::Transform(similarity, &light_field));
  constexpr double kLeastUnit_m = 1e-9;
  if (a.unit_m > 0 && a.unit_m < kLeastUnit_m)
    return lf::UsageError(
        fmt::format("--unit-m {}: expected metres per world unit from 1e-9 to 1e9", a.unit_m));
  if (a.unit_m > 0) light_field.unit_m = a.unit_m;
  return light_field;
}

lf::Result<void> Import(const Arguments& a, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  if (!a.output.empty())
    LF_RETURN_IF_ERROR(
        lf::CheckMayWrite(WritesAgain(a) ? "" : a.light_field.path, a.output, a.force));
  lf::ImportReport report;
  report.light_field = a.light_field.path;
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, OpenChanged(a, &report.excluded_count));
  report.first_image = light_field.ImagePath({0}).lexically_normal().string();
  lf::ThreadPool pool(common.threads);
  lf::CaptureReportOptions options;
  if (a.distance > 0) options.distance_w = a.distance;
  LF_ASSIGN_OR_RETURN(report.exif_gains,
                      lf::StateBrackets(a.exposure, pool, &light_field, &options.lights));
  report.capture = lf::ReportCapture(light_field, options, pool);
  size_t fault_count = 0;
  if (a.check != "none") {
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "images");
    lf::CheckOptions check;
    check.check = a.check == "pixels" ? lf::ImageCheck::kPixels : lf::ImageCheck::kHeaders;
    check.interrupted = &interrupted;
    check.progress = [&](size_t done, size_t total) { meter.Update(done, total, "checking"); };
    LF_ASSIGN_OR_RETURN(report.faults, lf::CheckImages(light_field, check, pool));
    lf::WarnOfFaults(light_field, &report);
    fault_count = report.faults->missing.size() + report.faults->broken.size();
  }
  if (interrupted)
    return lf::Error{lf::ErrorKind::kInterrupted, "interrupted before anything was written"};
  const bool refuses = fault_count == light_field.size() || (common.strict && fault_count > 0);
  if (a.exposure.match && !refuses) {
    LF_ASSIGN_OR_RETURN(report.exposure, lf::MatchAndApply(a.exposure, common, interrupted, pool,
                                                           &light_field, &report.capture));
  }
  lf::WarnOfBracketOptions(a.exposure, report.exif_gains, &light_field, &report.capture);
  if (!a.output.empty() && !refuses) {
    LF_ASSIGN_OR_RETURN(report.written, lf::WriteNativeFolder(a.output, &light_field));
  }
  LF_RETURN_IF_ERROR(
      lf::PrintReport(common.json ? lf::ReportJson(report) : lf::ReportText(report)));
  if (fault_count == 0) return {};
  const std::string what =
      fmt::format("{} of {} images are missing, {} broken", report.faults->missing.size(),
                  light_field.size(), report.faults->broken.size());
  if (refuses) return lf::InputError(what + "; nothing was written");
  return lf::EndWithMissing(
      {fault_count, light_field.size(), what, "rendering skips them, --exclude leaves them out"},
      limit);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfimport",
                      "Reports what a light field is and what looks wrong in it, and writes it as "
                      "the native transforms.json.",
                      kExamples);
  program.AddCommonOptions(
      {.threads = true,
       .strict = "Missing and broken images are an error, and nothing is written",
       .progress = true,
       .verbose = true,
       .quiet = true});
  AddOptions(program.app(), arguments);
  program.AddJsonOption("The report as JSON, with all digits");
  return program.Run(argc, argv, [&] { return Import(arguments, program.common()); });
}
