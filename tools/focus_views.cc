// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/help.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"
#include "tools/focus_frame.h"

#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/analysis/views/render_views.h"
#include "lf/analysis/views/view_files.h"
#include "lf/analysis/views/view_grid.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/core/quantities.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr HelpTexts kHelp = {
    .summary = "Resamples a light field to a regular grid of views in one orientation.",
    .usage = R"(  lffocus views LIGHTFIELD --grid COLUMNSxROWS -o OUT [OPTIONS])",
    .examples = R"(  lffocus views capture/ --grid 9x9 -o views
  lffocus views capture/ --grid 17x17 -o views.npy --values linear
  lffocus views handheld/ --grid 5x5 -o views --focus-distance 1.5)",
    .details =
        R"(The views are those of pinhole cameras in a plane, which all look in the mean direction of the LF
cameras: a 4D light field, as other programs expect it. They are spread evenly over the rectangle
around the LF cameras.

Where a view and an LF camera are at the same place (within 1 % of the grid's step), the view is its LF
image: unchanged if orientation and intrinsics agree, otherwise resampled without lens distortion. Other
views are interpolated between the LF images around them, and are sharp at one depth,
--focus-distance. The views have the intrinsics of the LF camera in the middle; if the light field is
rectified to a plane, so are the views.

OUT is a folder, or a file of NumPy if its name ends in .npy. A folder receives out_VV_UU_Y_X.png: row,
column, and position in millimetres, down and to the right, as the Stanford Light Field Archive names
images; and a transforms.json, with which the folder is a light field for all programs. It has the
light of LIGHTFIELD, also if that is brighter than display white, and masks the pixels where LIGHTFIELD
has recorded nothing. The array has
the shape [rows][columns][height][width][3]. lf.views() of the Python package also writes HDF5.

Views are made one at a time. If the program is interrupted, call it again with --overwrite.)",
};

struct Arguments {
  LightFieldArgument light_field;
  AllowMissing allow_missing;
  std::pair<int, int> grid = {0, 0};
  std::string output, values = "srgb8", focus_distance, memory = "8G";
  bool overwrite = false, clip = false;
};

void AddOptions(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  a.light_field.AddReduceTo(app);
  a.allow_missing.AddTo(app, "the LF images that are read");
  OptionGroup output(app, kOutputGroup);
  output.Add("-o,--output OUT", a.output, "Folder, or file: views.npy")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles(".npy folder"));
  output.AddChoice("--values", a.values, {"srgb8", "srgb16", "linear"},
                   "Values of the views\n"
                   "srgb8, srgb16: sRGB for display, with 8 or 16 bits (PNG, or uint8 or uint16)\n"
                   "linear: linear light as floats (EXR, or float32)\n"
                   "Where no LF image shows anything, pictures are transparent, and arrays are "
                   "not-a-number (linear) or black. Light darker than black is clipped in sRGB. "
                   "--clip decides about light that is brighter than display white.");
  output.AddFlag("--clip", a.clip,
                 "Clip light that is brighter than display white, in sRGB pictures\n"
                 "Without this option, pictures are darkened if there is such light, so that light "
                 "up to lf_max_radiance is kept: their values are light divided by the brightest "
                 "one, which transforms.json states as lf_gain. Arrays of sRGB values are always "
                 "clipped.");
  output.AddFlag("--overwrite", a.overwrite,
                 "Replace the views of OUT\n"
                 "Files of the same names are replaced, and those of a larger grid that "
                 "transforms.json lists are removed.");
  OptionGroup picture(app, kPictureGroup);
  picture.Add("--grid COLUMNSxROWS", a.grid, "Number of columns and rows of views, such as 9x9")
      ->delimiter('x')
      ->check(CLI::Range(1, kMostViewsAcross))
      ->required()
      ->default_str("");
  picture
      .Add("--focus-distance DISTANCE", a.focus_distance,
           "Depth at which rendered views are sharp (found)\n"
           "In world units, or in millimetres, such as 400mm. Found: in the middle of the depths "
           "of the scene that the light field states; if it states none, LF images are compared.")
      ->check(NotEmpty());
  OptionGroup running(app, kRunningGroup);
  running.Add("--memory SIZE", a.memory,
              "Upper limit of the memory of rendered views\n"
              "SIZE: such as 8G or 512M. With less memory, LF images are read in more passes.");
}

bool IsArray(const Arguments& a) { return fs::path(a.output).extension() == ".npy"; }

ViewValues ValuesOf(const std::string& name) {
  if (name == "srgb8") return ViewValues::kSrgb8;
  return name == "srgb16" ? ViewValues::kSrgb16 : ViewValues::kLinear;
}

Result<void> CheckOutputs(const Arguments& a, const LightField& light_field, const ViewGrid& grid) {
  const std::string extension = fs::path(a.output).extension().string();
  if (extension == ".h5" || extension == ".hdf5")
    return UsageError(fmt::format(
        "-o {}: lffocus writes no HDF5: give a name that ends in .npy, or write it in Python: "
        "lf.views(field, ({}, {}), file=\"{}\")",
        a.output, grid.rows(), grid.columns(), a.output));
  std::error_code error;
  const bool is_folder = fs::is_directory(a.output, error);
  if (IsArray(a) && is_folder)
    return UsageError(fmt::format("{}: is a folder: give the name of a file", a.output));
  if (!IsArray(a) && fs::exists(a.output, error) && !is_folder)
    return UsageError(fmt::format(
        "{}: is a file: give the name of a folder, or of a file that ends in .npy", a.output));
  if (!IsArray(a)) LF_RETURN_IF_ERROR(CheckFolderName(a.output, "views.npy"));
  std::vector<fs::path> files =
      IsArray(a) ? std::vector<fs::path>{a.output}
                 : FilesOfViews(grid, a.output, light_field.unit_m, ValuesOf(a.values));
  if (!IsArray(a))
    for (fs::path& other : OtherViews(grid, a.output, light_field.unit_m, ValuesOf(a.values)))
      files.push_back(std::move(other));
  LF_RETURN_IF_ERROR(CheckOutputFiles({files.begin(), files.end()},
                                      FilesOfLightField(light_field, a.light_field.path)));
  if (a.overwrite) return {};
  const auto old = std::find_if(files.begin(), files.end(),
                                [&](const fs::path& file) { return fs::exists(file, error); });
  if (old == files.end()) return {};
  return UsageError(fmt::format(
      "{}: exists already: give another -o, or replace it with --overwrite", old->string()));
}

std::string ReportJson(const ViewGrid& grid, const WrittenViews& written, double unit_m) {
  const ViewsReport& report = written.views;
  nlohmann::ordered_json json;
  json["columns"] = grid.columns();
  json["rows"] = grid.rows();
  json["width"] = grid.width_px();
  json["height"] = grid.height_px();
  json["step_w"] = {grid.step_w().x(), grid.step_w().y()};
  json["unit_m"] = unit_m;
  json["views_of_lf_images"] = report.recorded_count;
  json["views_not_resampled"] = report.copied_count;
  json["views_rendered"] = report.rendered_count;
  json["focus_distance_w"] = nullptr;
  if (report.focus_distance_w) json["focus_distance_w"] = *report.focus_distance_w;
  json["gain"] = written.gain;
  json["unrecorded_share"] = written.unrecorded_share;
  json["clipped_share"] = written.clipped_share;
  json["skipped_lf_images"] = report.missing;
  return RecordText(json);
}

void Tell(const Arguments& a, const ViewGrid& grid, const WrittenViews& written) {
  const ViewsReport& report = written.views;
  LogInfo("{}: {} x {} views of {} x {} pixels: {} are LF images, {} of these resampled{}",
          a.output, grid.columns(), grid.rows(), grid.width_px(), grid.height_px(),
          report.recorded_count, report.recorded_count - report.copied_count,
          report.rendered_count == 0
              ? ""
              : fmt::format("; {} are rendered, and sharp at {:.6g} world units",
                            report.rendered_count, *report.focus_distance_w));
  const auto percent = [](double share) { return fmt::format("{:.2g} %", 100 * share); };
  if (written.gain != 1)
    LogInfo(
        "{}: the brightest light is {:.4g}: values are light divided by it (lf_gain), so that it "
        "is kept; --values linear keeps light as it is, --clip keeps only what a display shows",
        a.output, written.gain);
  if (a.values == "linear") return;
  if (written.clipped_share > 0 && written.gain != 1)
    LogWarning(
        "{}: {} of the pixels are brighter than {:.4g}, the largest light that is kept "
        "(lf_max_radiance), because interpolation overshoots beside lights, and are clipped",
        a.output, percent(written.clipped_share), written.gain);
  else if (written.clipped_share > 0)
    LogWarning(
        "{}: {} of the pixels are brighter than display white, and are clipped: --values linear "
        "keeps their light",
        a.output, percent(written.clipped_share));
  if (IsArray(a) && written.unrecorded_share > 0)
    LogWarning(
        "{}: {} of the pixels are black because no LF image shows anything there: --values linear "
        "has not-a-number there, and in a folder they are transparent",
        a.output, percent(written.unrecorded_share));
}

Result<void> Run(const Arguments& a, const CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(const MissingLimit limit, a.allow_missing.Limit());
  const std::atomic<bool>& interrupted = CatchInterrupts();
  ThreadPool pool(common.threads);
  LF_ASSIGN_OR_RETURN(const LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(const ViewGrid grid,
                      ViewGrid::Make(light_field, a.grid.first, a.grid.second));
  LF_RETURN_IF_ERROR(CheckForViews(light_field));
  ViewOptions options;
  LF_ASSIGN_OR_RETURN(options.memory_bytes, ParseByteSize(a.memory, "--memory"));
  if (!a.focus_distance.empty()) {
    LF_ASSIGN_OR_RETURN(
        options.focus_distance_w,
        ParseFocusDistance(a.focus_distance, "--focus-distance", light_field.unit_m));
  }
  LF_RETURN_IF_ERROR(CheckOutputs(a, light_field, grid));
  // An array is one file, which is written in one step.
  std::optional<FileLock> lock;
  if (!IsArray(a)) {
    LF_ASSIGN_OR_RETURN(lock, LockOutputFolder(a.output));
    LF_RETURN_IF_ERROR(CheckOutputs(a, light_field, grid));  // another call may have ended just now
  }
  options.strict = common.strict;
  options.stop = options.interrupted = &interrupted;
  ProgressMeter meter(ParseProgressStyle(common.progress), "views");
  const auto make = [&](const ViewSink& sink) -> Result<ViewsReport> {
    Result<ViewsReport> made =
        MakeViews(light_field, grid, options, pool, sink,
                  [&](size_t done, size_t total) { meter.Update(done, total, ""); });
    if (!made && made.error().kind == ErrorKind::kInterrupted)
      return Error{made.error().kind, made.error().message + "; start again with --overwrite"};
    return made;
  };
  const ViewValues values = ValuesOf(a.values);
  LF_ASSIGN_OR_RETURN(const WrittenViews written,
                      IsArray(a)
                          ? WriteViewArray(grid, a.output, values, make)
                          : WriteViewFolder(light_field, grid, a.output, values, a.clip, make));
  const ViewsReport& report = written.views;
  Tell(a, grid, written);
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(ReportJson(grid, written, light_field.unit_m)));
  MissingImages missing{report.missing.size(), report.asked_count, "",
                        "once they are mended, make the views again"};
  if (missing.count > 0)
    missing.what = fmt::format("{} of {} LF images were left out, missing or broken; the first: {}",
                               missing.count, missing.asked, report.missing.front());
  return EndWithMissing(missing, limit);
}

}  // namespace

int RunFocusViews(int argc, char** argv) {
  Program program("lffocus views", kHelp);
  Arguments arguments;
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .strict = "Stop at a missing or broken LF image\n"
                                      "Without this option it is left out.",
                            .json = "Print what was made as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc - 1, argv + 1, [&] { return Run(arguments, program.common()); });
}

}  // namespace lf
