// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_epi.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
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

#include "lf/analysis/epi/epipolar_picture.h"
#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/core/version.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/state/record_fields.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr HelpTexts kHelp = {
    .summary = "Makes the epipolar picture of a row or a column of LF cameras.",
    .usage = R"(  lffocus epi LIGHTFIELD --row Y [-o FILE] [OPTIONS]
  lffocus epi LIGHTFIELD --column X [-o FILE] [OPTIONS])",
    .examples = R"(  lffocus epi capture/ --row 240 -o epi.png
  lffocus epi capture/ --row 240 --through image_0012.png -o epi.exr --json
  lffocus epi capture/ --column 320 --focus-distance 1.5 --thickness 8)",
    .details =
        R"(The picture of a row has one line for each LF camera of the row, from left to right: its pixel row Y. The
picture of a column has one column for each LF camera, from top to bottom: its pixel column X. A point
of the scene is a straight line in the picture, and its slope tells its depth: from one LF camera to the
next, it moves by -f p (1 / z - 1 / g) pixels, where f is the focal length in pixels, p the distance
between the LF cameras, z the depth of the point and g the focus distance (--focus-distance).

LF images are first resampled, without lens distortion, to cameras of one orientation, whose x axis (of a
column: y axis) is the line of the LF cameras. Y and X count pixels in this view of the LF camera
--through, from 0. Pixels that an LF image does not show are black, and not-a-number in EXR files.

--json prints what is in the picture: the LF image and the position of each line, f and g, the direction
of the line of LF cameras, and the rotation from world axes to those of the view. The files contain f, p
and g.)",
};

struct Arguments {
  LightFieldArgument light_field;
  AllowMissing allow_missing;
  std::string through, output = "epi.png", tolerance, focus_distance, lines = "auto";
  std::optional<int> row, column;
  std::optional<size_t> count;
  int thickness = 1;
  bool overwrite = false;
};

void AddOptions(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  a.light_field.AddReduceTo(app);
  OptionGroup input(app, kInputGroup);
  auto* row = input.Add("--row Y", a.row, "Pixel row, for a row of LF cameras")
                  ->check(CLI::Range(0, 1 << 20));
  input.Add("--column X", a.column, "Pixel column, for a column of LF cameras")
      ->check(CLI::Range(0, 1 << 20))
      ->excludes(row);
  input
      .Add("--through NAME", a.through,
           "LF image of the row or column (in the middle)\n"
           "The name of its file, as the calibration states it. If it is not given: the LF image "
           "whose camera is nearest to the middle of all.")
      ->check(NotEmpty());
  input
      .Add("--tolerance DISTANCE", a.tolerance,
           "How far an LF camera may be beside the line (found)\n"
           "In world units, such as 0.01, or in millimetres, such as 10mm. Found: a quarter of the "
           "median distance between neighbouring LF cameras.")
      ->check(NotEmpty());
  a.allow_missing.AddTo(app, "the LF images of the row or column");
  OptionGroup output(app, kOutputGroup);
  output
      .Add("-o,--output FILE", a.output,
           "Picture to write: .png or .exr\n"
           "PNG: sRGB, 8 bits. EXR: linear light, float.")
      ->check(NotEmpty())
      ->check(TakesFiles(".png .exr"));
  output.AddFlag("--overwrite", a.overwrite, "Replace FILE");
  OptionGroup picture(app, kPictureGroup);
  picture
      .Add("--focus-distance DISTANCE", a.focus_distance,
           "Depth of the points that do not move (infinity)\n"
           "Points at this depth are straight across the picture. In world units or, such as "
           "400mm, in millimetres.")
      ->check(NotEmpty());
  picture.AddChoice("--lines", a.lines, {"auto", "recorded", "nearest", "linear"},
                    "How lines are made of LF images\n"
                    "recorded: one line for each LF image, even if their positions are uneven\n"
                    "nearest: lines at even positions, each of the nearest LF image\n"
                    "linear: lines at even positions, interpolated between two LF images\n"
                    "auto: recorded if no LF camera is more than 2 % of a distance beside its "
                    "even place, otherwise nearest");
  picture
      .Add("--count N", a.count,
           "Number of lines at even positions (as LF images)\n"
           "Not with --lines recorded.")
      ->check(CLI::Range(size_t{2}, kMostEpipolarLines));
  picture
      .Add("--thickness PIXELS", a.thickness,
           "Thickness of each line in the picture\n"
           "More pixels make the lines of few LF images easier to see.")
      ->check(CLI::Range(1, 256));
}

EpipolarLines LinesOf(const std::string& name) {
  if (name == "recorded") return EpipolarLines::kRecorded;
  if (name == "nearest") return EpipolarLines::kNearest;
  return name == "linear" ? EpipolarLines::kLinear : EpipolarLines::kAuto;
}

const char* NameOf(EpipolarLines lines) {
  if (lines == EpipolarLines::kRecorded) return "recorded";
  return lines == EpipolarLines::kNearest ? "nearest" : "linear";
}

Result<EpipolarOptions> OptionsOf(const Arguments& a, const LightField& light_field, bool strict) {
  EpipolarOptions options;
  options.kind = a.row ? LineKind::kRow : LineKind::kColumn;
  options.pixel = a.row ? *a.row : *a.column;
  options.through = MiddleCamera(
      light_field, [&](LfImageId id) { return !light_field.cameras[id.value].is_virtual; });
  if (!a.through.empty()) {
    LF_ASSIGN_OR_RETURN(options.through, LfImageNamed(light_field, a.through));
  }
  if (!a.tolerance.empty()) {
    LF_ASSIGN_OR_RETURN(options.tolerance_w,
                        ParseFocusDistance(a.tolerance, "--tolerance", light_field.unit_m));
  }
  if (!a.focus_distance.empty()) {
    LF_ASSIGN_OR_RETURN(
        options.focus_distance_w,
        ParseFocusDistance(a.focus_distance, "--focus-distance", light_field.unit_m));
  }
  options.lines = LinesOf(a.lines);
  options.line_count = a.count;
  options.strict = strict;
  return options;
}

Result<void> CheckOutput(const Arguments& a, const LightField& light_field) {
  const std::string extension = std::filesystem::path(a.output).extension().string();
  if (extension != ".png" && extension != ".exr")
    return UsageError(fmt::format("-o {}: expected a name that ends in .png or .exr", a.output));
  // Inputs come first, because --overwrite does not replace them.
  LF_RETURN_IF_ERROR(CheckOutputFiles({std::filesystem::path(a.output)},
                                      FilesOfLightField(light_field, a.light_field.path)));
  std::error_code error;
  if (!a.overwrite && std::filesystem::exists(a.output, error))
    return UsageError(fmt::format(
        "{}: exists already: give another name, or replace it with --overwrite", a.output));
  return {};
}

// Returns the picture as it is written: lines are thick, and those of a column are upright.
Image<float> Arranged(const EpipolarPicture& picture, bool is_column, int thickness) {
  const Image<float>& light = picture.light;
  const int across = light.height() * thickness;
  Image<float> arranged(is_column ? across : light.width(), is_column ? light.width() : across, 3);
  for (int y = 0; y < arranged.height(); ++y)
    for (int x = 0; x < arranged.width(); ++x)
      for (int c = 0; c < 3; ++c)
        arranged.at(x, y, c) =
            is_column ? light.at(y, x / thickness, c) : light.at(x, y / thickness, c);
  return arranged;
}

void ConvertForDisplay(Image<float>* light) {
  for (float& value : light->pixels())
    value = std::isnan(value) ? 0 : static_cast<float>(SrgbFromLinear(value));
}

Result<void> Write(const Arguments& a, const LightField& light_field,
                   const EpipolarOptions& options, const EpipolarPicture& picture) {
  Image<float> arranged = Arranged(picture, options.kind == LineKind::kColumn, a.thickness);
  ImageMetadata metadata = {
      {"Software", fmt::format("lfrendertools {}", Version())},
      {options.kind == LineKind::kRow ? "lf:row" : "lf:column", options.pixel},
      {"lf:through", light_field.image_names[options.through.value]},
      {"lf:lines", std::string(NameOf(picture.lines))},
      {"lf:fx_px", picture.focal_px},
      {"lf:line_distance_w", (picture.positions_w.back() - picture.positions_w.front()) /
                                 static_cast<double>(picture.positions_w.size() - 1)},
      {"lf:unit_m", light_field.unit_m}};
  if (options.focus_distance_w)
    metadata.emplace_back("lf:focus_distance_w", *options.focus_distance_w);
  const bool is_exr = std::filesystem::path(a.output).extension() == ".exr";
  if (!is_exr) ConvertForDisplay(&arranged);
  return WriteImage(a.output, arranged.view(), {"R", "G", "B"},
                    is_exr ? PixelType::kFloat : PixelType::kUint8, metadata);
}

std::string ReportJson(const LightField& light_field, const EpipolarOptions& options,
                       const EpipolarPicture& picture) {
  nlohmann::ordered_json json;
  json[options.kind == LineKind::kRow ? "row" : "column"] = options.pixel;
  json["through"] = light_field.image_names[options.through.value];
  json["lines"] = NameOf(picture.lines);
  json["focal_px"] = picture.focal_px;
  json["unit_m"] = light_field.unit_m;
  json["focus_distance_w"] = nullptr;
  if (options.focus_distance_w) json["focus_distance_w"] = *options.focus_distance_w;
  json["farthest_from_line_w"] =
      *std::max_element(picture.line.distances_w.begin(), picture.line.distances_w.end());
  const Vec3& direction = picture.line.direction_world;
  json["direction"] = {direction.x(), direction.y(), direction.z()};
  const Mat3& rotation = picture.line.rotation;
  for (int row = 0; row < 3; ++row)
    json["view_from_world"].push_back({rotation(row, 0), rotation(row, 1), rotation(row, 2)});
  json["positions"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < picture.ids.size(); ++i)
    json["positions"].push_back({{"position_w", picture.positions_w[i]},
                                 {"lf_image", light_field.image_names[picture.ids[i].value]}});
  json["skipped_lf_images"] = nlohmann::ordered_json::array();
  for (const LfImageId id : picture.missing)
    json["skipped_lf_images"].push_back(light_field.image_names[id.value]);
  return RecordText(json);
}

Result<void> Run(const Arguments& a, const CommonOptions& common) {
  if (!a.row && !a.column)
    return UsageError("neither --row nor --column is given: expected one of them");
  LF_ASSIGN_OR_RETURN(const MissingLimit limit, a.allow_missing.Limit());
  const std::atomic<bool>& interrupted = CatchInterrupts();
  ThreadPool pool(common.threads);
  LF_ASSIGN_OR_RETURN(const LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(EpipolarOptions options, OptionsOf(a, light_field, common.strict));
  if (a.count && options.lines == EpipolarLines::kRecorded)
    return UsageError("--count cannot be used with --lines recorded: leave one of them out");
  options.stop = &interrupted;
  LF_RETURN_IF_ERROR(CheckOutput(a, light_field));
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store,
                      OpenStore(light_field, Mosaics::kToRgb));
  ProgressMeter meter(ParseProgressStyle(common.progress), "LF images");
  LF_ASSIGN_OR_RETURN(
      const EpipolarPicture picture,
      MakeEpipolarPicture(light_field, *store, options, pool,
                          [&](size_t done, size_t total) { meter.Update(done, total, ""); }));
  LF_RETURN_IF_ERROR(Write(a, light_field, options, picture));
  LogInfo("{}: {} lines of {} LF images from {:.6g} to {:.6g} world units beside {}, {}", a.output,
          picture.ids.size(), picture.line.ids.size(), picture.positions_w.front(),
          picture.positions_w.back(), light_field.image_names[options.through.value],
          picture.lines == EpipolarLines::kRecorded  ? "one for each LF image"
          : picture.lines == EpipolarLines::kNearest ? "each of the nearest LF image"
                                                     : "interpolated between LF images");
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(ReportJson(light_field, options, picture)));
  MissingImages missing{picture.missing.size(), picture.line.ids.size(), "",
                        "once they are mended, make the picture again"};
  if (missing.count > 0)
    missing.what = fmt::format("{} of {} LF images were left out, missing or broken; the first: {}",
                               missing.count, missing.asked, picture.first_reason);
  return EndWithMissing(missing, limit);
}

}  // namespace

int RunFocusEpi(int argc, char** argv) {
  Program program("lffocus epi", kHelp);
  Arguments arguments;
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .strict = "Stop at a missing or broken LF image\n"
                                      "Without this option its line is black.",
                            .json = "Print what is in the picture as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc - 1, argv + 1, [&] { return Run(arguments, program.common()); });
}

}  // namespace lf
