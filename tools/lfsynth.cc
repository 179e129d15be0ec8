// SPDX-License-Identifier: Apache-2.0
// lfsynth SCENE -o DIR: writes a synthetic scene as a light field and as exact thin-lens frames.
#include <atomic>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"

#include "lf/import/formats/open_light_field.h"
#include "lf/import/paths/open_path.h"
#include "lf/light_field/synthetic/synthetic_field.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfsynth"),
    .usage = "  lfsynth SCENE -o DIR [OPTIONS]",
    .examples = R"(  lfsynth still-life -o still-life
  lfsynth chart -o chart --capture band --count 600 --jitter 0.2 --format png
  lfsynth lights -o raw --bayer --noise 0.01
  lfsynth still-life -o phone --distortion 0.12,-0.25,0.001,-0.002
  lfsynth still-life -o still-life --calibration-only --truth path.yaml
  lfsynth chart -o cut-out --alpha straight --format png --truth path.yaml)",
    .details =
        R"(Scenes:
  still-life  glass, mirrors and marbles in front of strings of lights
  lights      only lights, at seven depths, on black
  chart       flat test charts at known depths and slants
  foliage     test charts behind sunlit leaves

The program writes DIR/images/0000.exr ... and DIR/transforms.json. With --truth it also writes
DIR/truth/frame_0001.exr ..., the frames that a real lens would film along the camera path. The world
unit is one metre.)",
};

struct Arguments {
  lf::SyntheticFieldOptions field;
  std::string truth;
};

void AddOutput(CLI::App& app, Arguments& arguments) {
  lf::SyntheticFieldOptions& a = arguments.field;
  lf::OptionGroup output(app, lf::kOutputGroup);
  output.Add("-o,--output DIR", a.output, "Folder of the light field")->required();
  output.AddChoice("--format", a.format, {"exr", "png", "png16"},
                   "File format of the LF images\n"
                   "exr: linear light as 16-bit floating-point numbers\n"
                   "png: 8-bit sRGB\n"
                   "png16: 16-bit, linear light");
  output.AddFlag("--calibration-only", a.calibration_only, "Write transforms.json without images");
  output.Add("--truth PATH", arguments.truth,
             "Also write ground truth frames of this camera path\n"
             "DIR/truth gets the frames that a real thin lens would film of the scene itself, to "
             "compare them with frames that are rendered from the LF images. If the path has a "
             "shutter, a frame is the mean of the pictures at its instants. The channel Z is the "
             "depth of the surface that is seen through the lens centre.");
  output.AddFlag("--overwrite", a.overwrite,
                 "Replace the light field in DIR\n"
                 "LF images of a light field that lfsynth wrote into DIR before are removed.");
}

void AddRig(CLI::App& app, lf::SyntheticFieldOptions& a) {
  lf::OptionGroup picture(app, lf::kPictureGroup);
  picture.AddChoice("--capture", a.capture, {"planar", "band", "hemisphere"},
                    "Arrangement of the LF cameras\n"
                    "planar: a grid\n"
                    "band: rows along an arc\n"
                    "hemisphere: a dome");
  picture.Add("--count N", a.count, "Approximate number of LF cameras (depends on the scene)")
      ->check(CLI::Range(0, 100'000'000));
  picture
      .Add("--size WIDTHxHEIGHT", a.size_px,
           "Size of the LF images (depends on the scene)\nSuch as 960x640.")
      ->delimiter('x')
      ->check(CLI::Range(1, 32768));
  picture.Add("--spacing X", a.spacing,
              "Distance between LF cameras, in metres (depends on the scene)\n"
              "Measured between neighbouring LF cameras.");
  picture.Add("--distance X", a.distance,
              "Distance to the scene, in metres (depends on the scene)\n"
              "Measured from the middle of the LF cameras to the middle of the scene.");
  picture.Add("--jitter X", a.jitter,
              "Largest random change of the LF cameras' poses\n"
              "Positions change by up to X times --spacing along each axis, directions by up to X "
              "degrees.");
}

void AddLens(CLI::App& app, lf::SyntheticFieldOptions& a) {
  lf::OptionGroup lens(app, "Lens of the LF cameras");
  lens.Add("--distortion K1,K2,...", a.distortion,
           "Lens distortion by OpenCV's model (none)\n"
           "The parameters are k1,k2,p1,p2,k3,k4,k5,k6 of OpenCV; those that are not given are 0.")
      ->delimiter(',')
      ->expected(1, 8)
      ->check(CLI::Range(-1e6, 1e6));
  lens.Add("--fisheye K1,K2,...", a.fisheye,
           "Fish-eye lens by OpenCV's model (none)\n"
           "The parameters are k1,k2,k3,k4 of OpenCV's fisheye model; those that are not given are "
           "0.")
      ->delimiter(',')
      ->expected(1, 4)
      ->check(CLI::Range(-1e6, 1e6))
      ->excludes("--distortion");
  lens.Add("--fov RADIANS", a.fov,
           "Fish-eye lens by COLMAP's FOV model (none)\n"
           "RADIANS is the parameter omega of the model: the field of view.")
      ->check(CLI::Range(1e-3, 3.14))
      ->excludes("--distortion")
      ->excludes("--fisheye");
}

void AddQuality(CLI::App& app, lf::SyntheticFieldOptions& a) {
  lf::OptionGroup picture(app, lf::kPictureGroup), quality(app, lf::kQualityGroup);
  picture.AddChoice("--alpha", a.alpha, {"none", "straight", "premultiplied"},
                    "Alpha of the LF images\n"
                    "straight, premultiplied: only the surfaces of the scene, on a transparent "
                    "background. The frames of --truth have premultiplied alpha.\n"
                    "none: the whole scene, without alpha");
  picture.AddFlag(
      "--bayer", a.bayer,
      "Write mosaics, as camera sensors record them\n"
      "Each pixel has one colour of the Bayer pattern RGGB. The images are 16-bit PNG files.");
  quality
      .Add("--noise X", a.noise,
           "Standard deviation of noise at radiance 1, for --bayer\n"
           "White has radiance 1. At radiance L the standard deviation is about X times the square "
           "root of L.")
      ->check(CLI::Range(0.0, 10.0));
  quality
      .Add("--samples N", a.samples,
           "Rays per pixel at edges (depends on the scene)\n"
           "More rays make edges in the LF images smoother. 0: the default of the scene.")
      ->check(CLI::Range(0, 4096));
  quality
      .Add("--truth-samples N", a.truth_samples,
           "Rays per pixel of the frames of --truth\n"
           "More rays give less noise and take more time.")
      ->check(CLI::Range(1, 1'000'000));
}

void AddOptions(CLI::App& app, Arguments& arguments) {
  lf::SyntheticFieldOptions& a = arguments.field;
  lf::OptionGroup input(app, lf::kInputGroup);
  input
      .AddChoice("SCENE", a.scene, {"still-life", "lights", "chart", "foliage"},
                 "still-life, lights, chart or foliage")
      ->required();
  AddOutput(app, arguments);
  AddRig(app, a);
  AddLens(app, a);
  AddQuality(app, a);
}

lf::Result<void> Write(const Arguments& arguments, const lf::CommonOptions& common) {
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  const lf::ProgressStyle style = lf::ParseProgressStyle(common.progress);
  lf::ProgressMeter images(style, "images"), frames(style, "frames");
  lf::SyntheticFieldOptions field = arguments.field;
  field.seed = common.seed;
  field.holds_light_field = lf::HoldsLightField;
  if (!arguments.truth.empty()) {
    LF_ASSIGN_OR_RETURN(
        const lf::CameraPath path,
        lf::OpenPath(arguments.truth,
                     {.light_field_unit_m = 1.0, .surface = lf::PathOptions::Surface::kMake}));
    field.truth_cameras.assign(path.AllInstants().begin(), path.AllInstants().end());
    field.truth_instants = path.shutter.samples;
    field.first_truth_frame = path.first_frame;
    field.inputs = lf::FilesOfPath(arguments.truth);
  }
  lf::ThreadPool pool(common.threads);
  return lf::WriteSyntheticField(field, pool, [&](size_t done, size_t total, bool is_truth) {
    (is_truth ? frames : images).Update(done, total, is_truth ? "truth" : field.scene);
    return !interrupted;
  });
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfsynth", kHelp);
  Arguments arguments;
  AddOptions(program.app(), arguments);
  program.AddCommonOptions(
      {.threads = true, .seed = "Seed of --jitter and --noise", .progress = true, .quiet = true});
  return program.Run(argc, argv, [&] { return Write(arguments, program.common()); });
}
