// lfsynth SCENE -o DIR: writes a synthetic scene as a light field and as exact thin-lens frames.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"

#include "lf/camera/path/path_yaml.h"
#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/log.h"
#include "lf/light_field/synthetic/built_in_scenes.h"
#include "lf/light_field/synthetic/write_light_field.h"
#include "lf/light_field/synthetic/write_truth.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = "Photographs a synthetic scene as a light field.",
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

The program writes DIR/images/0000.exr ... and DIR/transforms.json. With --truth it also writes
DIR/truth/frame_0001.exr ..., the frames that a real lens would film along the camera path. The world
unit is one metre.)",
};

struct Arguments {
  std::string scene, output, capture = "planar", format = "exr", alpha = "none", truth;
  std::optional<std::pair<int, int>> size_px;
  uint32_t count = 0;
  std::optional<double> spacing, distance;
  double jitter = 0, noise = 0;
  std::vector<double> distortion, fisheye;
  double fov = 0;
  int samples = 0, truth_samples = lf::LensSampling{}.samples;
  bool bayer = false, calibration_only = false, overwrite = false;
};

void AddOutput(CLI::App& app, Arguments& a) {
  lf::OptionGroup output(app, lf::kOutputGroup);
  output.Add("-o,--output DIR", a.output, "Folder of the light field")->required();
  output.AddChoice("--format", a.format, {"exr", "png", "png16"},
                   "File format of the LF images\n"
                   "exr: linear light as 16-bit floating-point numbers\n"
                   "png: 8-bit sRGB\n"
                   "png16: 16-bit, linear light");
  output.AddFlag("--calibration-only", a.calibration_only, "Write transforms.json without images");
  output.Add("--truth PATH.yaml", a.truth,
             "Also write ground truth frames of this camera path\n"
             "DIR/truth gets the frames that a real thin lens would film of the scene itself, to "
             "compare them with frames that are rendered from the LF images.");
  output.AddFlag("--overwrite", a.overwrite,
                 "Replace a light field in DIR not written by lfsynth\n"
                 "Needed if another program wrote the transforms.json in DIR, or if it was changed "
                 "after lfsynth "
                 "wrote it.");
}

void AddRig(CLI::App& app, Arguments& a) {
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

void AddLens(CLI::App& app, Arguments& a) {
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

void AddQuality(CLI::App& app, Arguments& a) {
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

void AddOptions(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup);
  input
      .AddChoice("SCENE", a.scene, {"still-life", "lights", "chart"}, "still-life, lights or chart")
      ->required();
  AddOutput(app, a);
  AddRig(app, a);
  AddLens(app, a);
  AddQuality(app, a);
}

lf::Result<lf::RigOptions> MakeRigOptions(const Arguments& a, const lf::BuiltInScene& scene) {
  lf::RigOptions rig = scene.rig;
  if (a.capture == "band") rig.shape = lf::RigShape::kBand;
  if (a.capture == "hemisphere") rig.shape = lf::RigShape::kHemisphere;
  if (rig.shape == lf::RigShape::kHemisphere && a.spacing)
    return lf::UsageError(
        "--spacing cannot be used with --capture hemisphere, where --count and --distance "
        "determine it: leave it out");
  if (a.count > 0) rig.count = a.count;
  rig.spacing_w = a.spacing.value_or(rig.spacing_w);
  rig.distance_w = a.distance.value_or(rig.distance_w);
  rig.jitter = a.jitter;
  return rig;
}

lf::Distortion DistortionOf(const Arguments& a) {
  lf::Distortion distortion;
  const auto set = [&](lf::DistortionModel model, const std::vector<double>& parameters) {
    if (parameters.empty()) return;
    distortion.model = model;
    std::copy(parameters.begin(), parameters.end(), distortion.parameters.begin());
  };
  set(lf::DistortionModel::kRadialTangential, a.distortion);
  set(lf::DistortionModel::kFisheye, a.fisheye);
  if (a.fov > 0) set(lf::DistortionModel::kFov, {a.fov});
  return distortion;
}

lf::Result<lf::LfImageFormat> FormatOf(const Arguments& a) {
  if (a.bayer && a.format != "exr")
    return lf::UsageError(
        "--bayer and --format cannot be combined, because mosaics are always 16-bit PNG: leave one "
        "out");
  if (a.alpha != "none" && a.bayer)
    return lf::UsageError(
        "--bayer and --alpha cannot be combined, because mosaics have no alpha: leave one out");
  if (a.alpha != "none" && a.scene == "lights")
    return lf::UsageError(
        "--alpha cannot be used with the scene lights, which has no surfaces: use another scene, "
        "or leave --alpha out");
  if (a.noise > 0 && !a.bayer)
    return lf::UsageError(
        "--noise can only be used with mosaics: add --bayer, or leave --noise out");
  if (a.bayer) return lf::LfImageFormat::kBayer;
  if (a.format == "png") return lf::LfImageFormat::kPng;
  return a.format == "png16" ? lf::LfImageFormat::kPng16 : lf::LfImageFormat::kExr;
}

std::filesystem::path CalibrationIn(const Arguments& a) {
  return std::filesystem::path(a.output) / "transforms.json";
}

lf::Result<lf::FileLock> LockFolder(const std::filesystem::path& folder) {
  LF_RETURN_IF_ERROR(lf::CreateFolder(folder));
  LF_ASSIGN_OR_RETURN(lf::FileLock lock, lf::FileLock::Take(folder / ".lfsynth.lock"));
  lock.RemoveInTheEnd();
  return lock;
}

// Refuses to overwrite a light field that lfsynth did not write, or that was edited since.
lf::Result<void> CheckMayWrite(const Arguments& a) {
  std::error_code error;
  if (a.overwrite || !std::filesystem::exists(CalibrationIn(a), error)) return {};
  LF_ASSIGN_OR_RETURN(const bool is_ours, lf::IsAsWritten(CalibrationIn(a), lf::kSynthProgram));
  if (is_ours) return {};
  return lf::UsageError(
      fmt::format("{}: was not written by lfsynth, or was changed afterwards: give another folder, "
                  "or replace this "
                  "light field with --overwrite",
                  CalibrationIn(a).string()));
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfsynth", kHelp);
  Arguments a;
  AddOptions(program.app(), a);
  program.AddCommonOptions(
      {.threads = true, .seed = "Seed of --jitter and --noise", .progress = true, .quiet = true});
  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    const lf::BuiltInScene& built_in = *lf::FindBuiltInScene(a.scene);
    const lf::ProgressStyle style = lf::ParseProgressStyle(program.common().progress);
    const uint64_t seed = program.common().seed;
    lf::CatchInterrupts();
    LF_ASSIGN_OR_RETURN(const lf::LfImageFormat format, FormatOf(a));
    LF_ASSIGN_OR_RETURN(lf::RigOptions rig, MakeRigOptions(a, built_in));
    rig.seed = seed;
    LF_ASSIGN_OR_RETURN(const std::vector<lf::RigidTransform> poses, lf::MakeRig(rig));
    lf::CameraPath path;
    if (!a.truth.empty()) {
      LF_ASSIGN_OR_RETURN(path, lf::ReadPathYaml(a.truth, 1.0));
    }
    // The lock keeps two processes from mixing their scenes in one folder.
    LF_ASSIGN_OR_RETURN(const lf::FileLock lock, LockFolder(a.output));
    LF_RETURN_IF_ERROR(CheckMayWrite(a));
    const auto [width_px, height_px] =
        a.size_px.value_or(std::pair(built_in.width_px, built_in.height_px));
    lf::Intrinsics intrinsics = lf::IntrinsicsFor(built_in, width_px, height_px);
    intrinsics.distortion = DistortionOf(a);
    lf::LightField light_field =
        lf::DescribeLightField(poses, intrinsics, format, built_in.max_radiance, a.output);
    light_field.encoding.alpha = lf::AlphaMeaningOf(a.alpha);
    const lf::Surroundings surroundings = light_field.encoding.AlphaIsLight()
                                              ? lf::Surroundings::kTransparent
                                              : lf::Surroundings::kShown;
    lf::ThreadPool pool(program.common().threads);
    const lf::Scene scene(built_in.describe());
    if (a.calibration_only) {
      LF_RETURN_IF_ERROR(lf::CreateFolder(a.output));
      LF_RETURN_IF_ERROR(lf::WriteTransformsJson(light_field, CalibrationIn(a), lf::kSynthProgram));
    } else {
      lf::ProgressMeter meter(style, "images");
      const auto keep_going = [&](size_t done) {
        meter.Update(done, poses.size(), a.scene);
        return !lf::CatchInterrupts();
      };
      const int samples = a.samples > 0 ? a.samples : built_in.samples;
      LF_RETURN_IF_ERROR(lf::WriteLightField(scene, light_field,
                                             {format, samples, a.noise, seed, keep_going}, pool));
    }
    lf::LogInfo("{}: {} LF cameras, {:.4g} apart", a.output, poses.size(), lf::RigPitch(rig));
    if (a.truth.empty()) return {};
    lf::ProgressMeter meter(style, "frames");
    return lf::WriteTruth(scene, path.cameras, {a.truth_samples, 0}, light_field.folder / "truth",
                          pool, surroundings, [&](size_t done) {
                            meter.Update(done, path.frame_count(), "truth");
                            return !lf::CatchInterrupts();
                          });
  });
}
