// SPDX-License-Identifier: Apache-2.0
// lfpath PATH [-o OUT]: tells what a camera path is, converts it and changes it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/validators.h"

#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/camera/path/camera_table.h"
#include "lf/camera/path/view_cameras.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/film/develop/quilt_devices.h"
#include "lf/import/check/similarity.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/resample_path.h"
#include "lf/import/paths/write_path.h"
#include "lf/render/pipeline/check_outputs.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfpath"),
    .usage = R"(  lfpath PATH [OPTIONS]
  lfpath PATH -o OUT [OPTIONS])",
    .examples = R"(  lfpath camera_path.json                       # what is in it
  lfpath camera_path.json -o path.yaml --f-number 2 --focus-distance 1.5
  lfpath path.yaml -o base_cam.json --format instant-ngp
  lfpath nuke.chan -o path.yaml --fps 24 --resolution 1920x1080 --f-number 2 --focus-distance 3
  lfpath path.yaml -o slow.yaml --frames 240
  lfpath path.yaml -o moved.yaml --transform upright.txt --scale 0.5
  lfpath path.yaml -o stereo.yaml --stereo-mm 65
  lfpath path.yaml -o quilt.yaml --quilt 8x6 --convergence 1.5)",
    .details =
        R"(PATH is our own YAML, a path of nerfstudio, instant-ngp or Nuke, or a calibration whose cameras become
frames; doc/formats/foreign_paths.md has their conventions. A warning lists what PATH does not state, and the value that is used; the options of
"Picture" state it, and replace what PATH states. Without -o, the program prints the camera of every
frame, as lfcammvminfo does.

--stereo and --quilt make several views of every frame: the views of the first frame, those of the
second, and so on. Their cameras stand side by side, are parallel, and have shifted plates, so that the plane of
convergence is at the same place in all views. Render OUT as any path; lfquilt then puts the views
together (doc/stereo.md).

In OUT, every frame has a camera of its own: accelerations and curves are not kept. Only our own YAML
keeps a shutter. A warning tells what the format of OUT cannot hold. JSON files have lf_ keys, from
which our programs restore everything: frames that are rendered with such a file have the same bits.)",
};

struct Arguments {
  std::string path, light_field, dataparser, output, format, out_dataparser, transform;
  std::string rotation_order = "zxy", fov_unit;
  std::optional<double> unit_m, ngp_scale, sensor_width_mm, f_number, aperture_diameter_mm;
  std::optional<double> focal_length_mm, focus_distance, fps;
  std::optional<std::pair<int, int>> resolution;
  std::vector<double> ngp_offset;
  std::optional<uint32_t> frames, first_frame;
  double scale = 1;
  std::optional<double> separation_w, separation_mm, view_angle_deg;
  std::string convergence;
  std::optional<std::pair<int, int>> quilt;  // columns, rows
  std::string device;
  bool overwrite = false;

  bool makes_views() const { return separation_w || separation_mm || quilt; }
};

void AddInput(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup);
  input.Add("PATH", a.path, lf::kPathHelp)->required();
  input
      .Add("--lightfield LIGHTFIELD", a.light_field,
           "Light field that the path is for (none)\n"
           "It states the unit, the depths to focus on by default, and what a transforms.json says "
           "about the spaces of nerfstudio and instant-ngp.")
      ->check(lf::NotEmpty());
  input.Add("--unit-m METRES", a.unit_m, "Metres per world unit, if nothing else states it")
      ->check(CLI::Range(1e-9, 1e9));
  lf::OptionGroup spaces(app, "Spaces of other programs");
  spaces
      .Add("--dataparser-transforms FILE", a.dataparser,
           "dataparser_transforms.json for PATH (beside PATH)\n"
           "The file states the space in which nerfstudio trained; PATH is moved back from it.")
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".json"));
  spaces
      .Add("--out-dataparser-transforms FILE", a.out_dataparser,
           "dataparser_transforms.json for OUT (none)\n"
           "OUT is moved into the space in which nerfstudio trained, so that nerfstudio can render "
           "it. Without it, OUT is in the world of the light field.")
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".json"));
  spaces
      .Add("--ngp-scale X", a.ngp_scale,
           "Scale of the space of instant-ngp (0.33)\n"
           "If it is not given: \"scale\" of the transforms.json of the light field, or of that "
           "beside PATH; 0.33 if there is none.")
      ->check(CLI::Range(1e-9, 1e9));
  spaces
      .Add("--ngp-offset X,Y,Z", a.ngp_offset,
           "Offset of the space of instant-ngp (0.5,0.5,0.5)\n"
           "If it is not given: \"offset\" of the same file; 0.5 in each direction if there is "
           "none.")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(-1e6, 1e6));
  spaces.AddChoice(
      "--rotation-order", a.rotation_order, {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx"},
      "Order of the rotations in .chan files\n"
      "zxy: first about z, then about x, then about y. A .chan does not state its order; "
      "zxy is Nuke's default. It is used for PATH and for OUT.");
  spaces.AddChoice("--fov-unit", a.fov_unit, {"degrees", "radians"},
                   "Unit of the fields of view in PATH (degrees)\n"
                   "For paths of nerfstudio and instant-ngp, and .chan files. Without it, a path "
                   "whose fields of "
                   "view are all below pi is refused, because they may be radians.");
}

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  auto* out = output.Add("-o,--output OUT", a.output, "Path to write")
                  ->check(lf::NotEmpty())
                  ->check(lf::TakesFiles(".yaml .json .chan .usda"));
  output
      .AddChoice("--format", a.format, {"yaml", "nerfstudio", "instant-ngp", "chan", "usda"},
                 "Format of OUT (by its extension)\n"
                 ".yaml is our own format, .json nerfstudio's, .chan Nuke's, .usda a scene of USD.")
      ->needs(out);
  output
      .Add(
          "--transform FILE|MATRIX", a.transform,
          "Move the cameras by a 4x4 matrix\n"
          "MATRIX: 16 numbers, row by row. FILE: a file with 16 numbers. The matrix maps points of "
          "the old world to the new one: a rotation, a scale and a translation. Lenses are scaled "
          "as well.")
      ->check(lf::NotEmpty());
  output.Add("--scale X", a.scale, "Multiply all lengths by X, after --transform")
      ->check(CLI::Range(1e-9, 1e9));
  output
      .Add("--fps RATE", a.fps,
           "Frames per second (as PATH states, else 30)\n"
           "If PATH states another rate, the path is resampled: it lasts as long as before. With "
           "several views of each moment, the rate is that of the moments. A fraction is a rate: "
           "24000/1001.")
      ->transform(lf::Rate())
      ->check(CLI::Range(1e-3, 1e6));
  output
      .Add(
          "--frames N", a.frames,
          "Number of frames (as PATH states)\n"
          "The frames are spread evenly from the first camera to the last. The rate stays, so that "
          "the film takes longer or shorter. With several views of each moment, N counts all views "
          "and is a multiple of their number.")
      ->check(CLI::Range(1, 1'000'000));
  output
      .Add("--first-frame N", a.first_frame,
           "Number of the first frame, such as 1001 (as PATH states, else 1)\n"
           "Frames then have these numbers in file names, in --frames and in messages.")
      ->check(CLI::Range(uint32_t{0}, lf::kLargestFrameNumber));
  output.AddFlag("--overwrite", a.overwrite, "Replace OUT")->needs(out);
}

void AddViews(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  auto* stereo = output
                     .Add("--stereo SEPARATION", a.separation_w,
                          "Make two views of every frame, for left and right eye\n"
                          "SEPARATION: distance of the eyes in world units, after --scale.")
                     ->check(CLI::Range(1e-9, 1e9));
  auto* stereo_mm =
      output.Add("--stereo-mm MM", a.separation_mm, "As --stereo, with the separation in mm")
          ->check(CLI::Range(1e-9, 1e9))
          ->excludes(stereo);
  auto* quilt = output
                    .Add("--quilt CxR", a.quilt,
                         "Make the views of a light field display\n"
                         "C columns times R rows of views for every frame, from the leftmost to "
                         "the rightmost. "
                         "The first view is the lower left tile of the quilt that lfquilt makes.")
                    ->delimiter('x')
                    ->check(CLI::Range(1, 1000))
                    ->excludes(stereo)
                    ->excludes(stereo_mm);
  output
      .Add("--device NAME", a.device,
           "Make the views of this Looking Glass display\n"
           "NAME: portrait, go, 16-landscape, 16-portrait, 32-landscape, 32-portrait or 65. "
           "It decides --quilt, and the size of the frames unless --resolution is given, by "
           "the settings of the maker (doc/stereo.md). Frames have the aspect of the display; "
           "lfquilt --device squeezes them into the tiles.")
      ->check(CLI::IsMember(lf::NamesOfQuiltDevices()))
      ->excludes(stereo)
      ->excludes(stereo_mm)
      ->excludes(quilt);
  output
      .Add("--view-angle DEGREES", a.view_angle_deg,
           "Angle that the views of a quilt fill (35)\n"
           "The angle between the outermost views, seen from the plane of convergence. Makers of "
           "light field displays recommend 35 to 40 degrees.")
      ->check(CLI::Range(lf::kLeastViewAngle_deg, lf::kMostViewAngle_deg));
  output
      .Add("--convergence DISTANCE", a.convergence,
           "Distance where all views agree (the focus distance)\n"
           "Along the optical axis, in world units, such as 0.4, or in millimetres, such as 400mm, "
           "for all views: points at this distance appear on the screen, nearer ones in "
           "front of it. Without it, each frame has its own focus distance.")
      ->check(lf::NotEmpty());
}

void AddPicture(CLI::App& app, Arguments& a) {
  lf::OptionGroup picture(app, lf::kPictureGroup);
  picture
      .Add("--resolution WxH", a.resolution,
           "Size of the frames (as PATH states, else 1920x1080)\n"
           "If PATH states another size, the field of view of the width is kept.")
      ->delimiter('x')
      ->check(CLI::Range(1, 65536));
  auto* number = picture.Add("--f-number N", a.f_number, "Focal length divided by diameter")
                     ->check(CLI::Range(1e-6, 1e9));
  picture
      .Add("--aperture-diameter-mm MM", a.aperture_diameter_mm,
           "Diameter of the aperture (as PATH states, else 0)\n"
           "0: a pinhole, which sees few LF cameras.")
      ->check(CLI::Range(0.0, 1e9))
      ->excludes(number);
  picture
      .Add("--focus-distance X", a.focus_distance,
           "Focus distance in world units (as PATH states)\n"
           "If PATH states none: the middle of the depth range of --lightfield, otherwise 1.")
      ->check(CLI::Range(1e-9, 1e9));
  picture
      .Add("--sensor-width-mm MM", a.sensor_width_mm,
           "Width of the sensor (as PATH states, else 36)\n"
           "The field of view is kept; the focal length follows.")
      ->check(CLI::Range(1e-6, 1e9));
  picture
      .Add("--focal-length-mm MM", a.focal_length_mm,
           "Focal length, for a PATH without field of view (50)\n"
           "For .chan files without it, and for poses that ns-export of nerfstudio wrote. "
           "Together with the width of the sensor, it gives the field of view.")
      ->check(CLI::Range(1e-6, 1e9));
}

// kUsage if OUT is a file that is read besides PATH, or must not be replaced.
lf::Result<void> CheckOutput(const Arguments& a, const std::vector<std::filesystem::path>& inputs) {
  if (a.output.empty()) return {};
  std::error_code error;
  if (!a.overwrite && std::filesystem::exists(a.output, error))
    return lf::UsageError(fmt::format(
        "{}: exists already: give another name, or replace it with --overwrite", a.output));
  LF_RETURN_IF_ERROR(lf::CheckOutputFiles({std::filesystem::path(a.output)}, inputs));
  return lf::CheckReplacesPath(a.output);
}

// Returns the options for reading PATH. kUsage: errors of CheckOutput().
lf::Result<lf::PathOptions> OptionsOf(const Arguments& a) {
  lf::PathOptions options;
  std::vector<std::filesystem::path> inputs = lf::FilesOfPath(a.path);
  inputs.erase(inputs.begin());  // with --overwrite, PATH itself may be changed in its place
  for (const std::string* file : {&a.dataparser, &a.out_dataparser, &a.transform})
    inputs.emplace_back(*file);
  if (!a.light_field.empty()) {
    LF_ASSIGN_OR_RETURN(const lf::LightField light_field,
                        lf::OpenLightField(a.light_field, {.takes_any_time = true}));
    for (std::filesystem::path& file : lf::FilesOfLightField(light_field, a.light_field))
      inputs.push_back(std::move(file));
    options = lf::PathOptionsFor(light_field);
  }
  LF_RETURN_IF_ERROR(CheckOutput(a, inputs));
  if (a.unit_m) options.light_field_unit_m = a.unit_m;
  options.dataparser_transforms = a.dataparser;
  options.ngp_scale = a.ngp_scale;
  if (!a.ngp_offset.empty()) options.ngp_offset = lf::Vec3(a.ngp_offset.data());
  options.surface = lf::PathOptions::Surface::kName;
  if (a.resolution) options.resolution_px = {a.resolution->first, a.resolution->second};
  options.sensor_width_mm = a.sensor_width_mm;
  options.focal_length_mm = a.focal_length_mm;
  options.rotation_order = *lf::RotationOrderOf(a.rotation_order);
  options.fov_unit = lf::FovUnitOf(a.fov_unit);
  options.f_number = a.f_number;
  options.aperture_diameter_mm = a.aperture_diameter_mm;
  options.focus_distance_w = a.focus_distance;
  options.fps = a.fps;
  options.frame_count = a.frames;
  return options;
}

// Returns the cameras of all views, or the path as it is if no views are asked for.
lf::Result<lf::CameraPath> ViewsOf(const Arguments& a, lf::CameraPath path) {
  constexpr double kDefaultViewAngle_deg = 35;
  if (!a.makes_views() && !a.convergence.empty())
    return lf::UsageError(
        "--convergence can only be used with --stereo, --stereo-mm, --quilt or --device: leave it "
        "out, or give one of them");
  if (!a.quilt && a.view_angle_deg)
    return lf::UsageError(
        "--view-angle can only be used with --quilt or --device: leave it out, or give one of "
        "them");
  if (!a.makes_views()) return path;
  std::optional<double> convergence_w;
  if (!a.convergence.empty()) {
    LF_ASSIGN_OR_RETURN(convergence_w,
                        lf::ParseFocusDistance(a.convergence, "--convergence", path.unit_m));
  }
  if (!a.quilt)
    return lf::StereoPath(path,
                          a.separation_w.value_or(a.separation_mm.value_or(0) * 1e-3 / path.unit_m),
                          convergence_w);
  const int view_count = a.quilt->first * a.quilt->second;
  if (view_count < 2) return lf::UsageError("--quilt 1x1 has a single view: expected at least 2");
  return lf::QuiltPath(path, view_count,
                       lf::RadiansFromDegrees(a.view_angle_deg.value_or(kDefaultViewAngle_deg)),
                       convergence_w);
}

// Gives the frames the numbers of --first-frame.
lf::Result<lf::CameraPath> Renumbered(const Arguments& a, lf::CameraPath path) {
  if (!a.first_frame || *a.first_frame == path.first_frame) return path;
  if (path.focal_surface && lf::HasFilePerFrame(*path.focal_surface))
    return lf::InputError(fmt::format(
        "--first-frame {}: the focal surface {} has a file for the number of each frame, from {} "
        "on: leave --first-frame out, or give the files other numbers and state first_frame in the "
        "path",
        *a.first_frame, path.focal_surface->file, path.first_frame));
  path.first_frame = *a.first_frame;
  return path;
}

lf::Result<void> CheckNumbers(const lf::CameraPath& path) {
  if (path.frames().last() <= lf::kLargestFrameNumber) return {};
  return lf::UsageError(fmt::format(
      "the last of {} frames from {} on has the number {}, above {}: give a smaller --first-frame",
      path.frame_count(), path.first_frame, path.frames().last(), lf::kLargestFrameNumber));
}

lf::Result<lf::CameraPath> Changed(const Arguments& a, lf::CameraPath path) {
  LF_ASSIGN_OR_RETURN(const lf::Similarity similarity, lf::ReadSimilarity(a.transform, a.scale));
  if (!a.transform.empty() || a.scale != 1)
    LF_RETURN_IF_ERROR(lf::MovePath(similarity, a.path, &path));
  if ((a.fps && *a.fps != path.fps) || (a.frames && *a.frames != path.frame_count()))
    return lf::ResamplePath(path, a.fps, a.frames);
  return path;
}

lf::Result<lf::PathFormat> FormatOf(const Arguments& a) {
  if (!a.format.empty()) return *lf::PathFormatOf(a.format);
  if (const std::optional<lf::PathFormat> format = lf::PathFormatOfFile(a.output)) return *format;
  return lf::UsageError(fmt::format(
      "-o {}: its extension stands for no format: expected .yaml, .json, .chan or .usda, or give "
      "--format",
      a.output));
}

lf::Result<void> Write(const Arguments& a, lf::PathOptions options, const lf::CameraPath& path) {
  LF_ASSIGN_OR_RETURN(const lf::PathFormat format, FormatOf(a));
  if (!a.out_dataparser.empty() && format != lf::PathFormat::kNerfstudio)
    return lf::UsageError(
        fmt::format("--out-dataparser-transforms can only be used with --format nerfstudio, but {} "
                    "is written as {}: leave it out",
                    a.output, lf::NameOf(format)));
  options.dataparser_transforms = a.out_dataparser;
  LF_ASSIGN_OR_RETURN(const std::vector<std::string> lost,
                      lf::WritePath(path, a.output, format, options));
  if (path.shutter.exists() && format == lf::PathFormat::kYaml)
    lf::LogWarning(
        "{}: the cameras at which the shutter exposes a frame are interpolated between the cameras "
        "of the frames; before the first frame and after the last one, the camera stands still, so "
        "that these two frames are blurred less",
        a.output);
  if (!lost.empty())
    lf::LogWarning("{}: the format has no place for {}", a.output, fmt::join(lost, "; for "));
  const size_t moments = path.moment_count();
  const std::string views = path.views == 1
                                ? ""
                                : fmt::format(", {} views of each of {} moment{},", path.views,
                                              moments, moments == 1 ? "" : "s");
  lf::LogInfo("{}: {} frame{}{} at {} {}per second, as {}", a.output, path.frame_count(),
              path.frame_count() == 1 ? "" : "s", views, path.fps,
              path.views == 1 ? "" : "moments ", lf::NameOf(format));
  return {};
}

// Makes the name of the focal surface relative to the folder of the path that is written.
void NameFromOutput(const Arguments& a, lf::CameraPath* path) {
  namespace fs = std::filesystem;
  if (a.output.empty() || !path->focal_surface) return;
  const fs::path file = path->focal_surface->file;
  if (file.is_absolute()) return;
  const fs::path from = fs::absolute(a.path).lexically_normal().parent_path();
  const fs::path to = fs::absolute(a.output).lexically_normal().parent_path();
  if (from != to)
    path->focal_surface->file = (from / file).lexically_normal().lexically_relative(to).string();
}

// Chooses the views, and their size, that a display is given. kUsage: frames of
// --resolution have another shape than the display.
lf::Result<void> ApplyDevice(Arguments* a) {
  if (a->device.empty()) return {};
  const lf::QuiltDevice& device = lf::QuiltDeviceNamed(a->device);
  a->quilt = {device.grid.columns, device.grid.rows};
  const lf::ViewSize least = device.view();
  if (!a->resolution) a->resolution = {least.width, least.height};
  const auto [width, height] = *a->resolution;
  constexpr double kMostOff = 0.01;  // as lfquilt allows
  const double aspect = static_cast<double>(width) / height;
  if (std::abs(aspect / device.aspect() - 1) <= kMostOff) return {};
  return lf::UsageError(fmt::format(
      "--resolution {}x{}: has width / height {:.3f}, but the views of --device {} have {:.3f}: "
      "leave --resolution out, which makes {}x{}",
      width, height, aspect, a->device, device.aspect(), least.width, least.height));
}

lf::Result<void> Run(const Arguments& a, bool json) {
  LF_ASSIGN_OR_RETURN(const lf::PathOptions options, OptionsOf(a));
  LF_ASSIGN_OR_RETURN(lf::CameraPath opened, lf::OpenPath(a.path, options));
  NameFromOutput(a, &opened);
  LF_ASSIGN_OR_RETURN(lf::CameraPath changed, Changed(a, std::move(opened)));
  LF_ASSIGN_OR_RETURN(lf::CameraPath numbered, Renumbered(a, std::move(changed)));
  LF_ASSIGN_OR_RETURN(const lf::CameraPath path, ViewsOf(a, std::move(numbered)));
  LF_RETURN_IF_ERROR(CheckNumbers(path));
  if (!a.output.empty()) LF_RETURN_IF_ERROR(Write(a, options, path));
  if (!a.output.empty() && !json) return {};
  const std::vector<lf::FrameId> frames = path.frames().All();
  return lf::PrintReport(json ? lf::CameraJson(path, frames) : lf::CameraTable(path, frames));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfpath", kHelp);
  AddInput(program.app(), arguments);
  AddOutput(program.app(), arguments);
  AddViews(program.app(), arguments);
  AddPicture(program.app(), arguments);
  program.AddCommonOptions({.json = "Print the cameras as JSON, with all digits\n"
                                    "Infinite numbers are null.",
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    LF_RETURN_IF_ERROR(ApplyDevice(&arguments));
    return Run(arguments, program.common().json);
  });
}
