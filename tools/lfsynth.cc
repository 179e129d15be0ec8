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

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/log.h"
#include "lf/native/transforms_json.h"
#include "lf/path/path_yaml.h"
#include "lf/synthetic/built_in_scenes.h"
#include "lf/synthetic/write_light_field.h"
#include "lf/synthetic/write_truth.h"

namespace {

constexpr const char* kExamples = R"(Scenes:
  still-life  glass, mirrors and marbles before strings of lights
  lights      lights alone at seven depths, on black
  chart       flat test charts at known depths and slants

Examples:
  lfsynth still-life -o still-life
  lfsynth chart -o chart --capture band --count 600 --jitter 0.2 --format png
  lfsynth lights -o raw --bayer --noise 0.01
  lfsynth still-life -o phone --distortion 0.12,-0.25,0.001,-0.002
  lfsynth still-life -o still-life --calibration-only --truth path.yaml
  lfsynth chart -o cut-out --alpha straight --format png --truth path.yaml

DIR receives images/0000.exr ... and transforms.json; with --truth also truth/frame_0001.exr ...,
the frames that a real lens would film along a camera path. Lengths are metres.)";

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

void AddOptions(CLI::App& app, Arguments& a) {
  const CLI::IsMember scenes({"still-life", "lights", "chart"});
  app.add_option("SCENE", a.scene, "One of the scenes below")->required()->check(scenes);
  app.add_option("-o,--output", a.output, "Folder to write")->required();
  app.add_option("--capture", a.capture, "Grid, band on an arc, or dome of LF cameras")
      ->check(CLI::IsMember({"planar", "band", "hemisphere"}));
  app.add_option("--count", a.count, "LF cameras, about; 0: as the scene recommends")
      ->check(CLI::Range(0, 100'000'000));
  app.add_option("--size", a.size_px, "Of the LF images, such as 960x640")
      ->type_name("WxH")
      ->delimiter('x')
      ->check(CLI::Range(1, 32768));
  app.add_option("--spacing", a.spacing, "From LF camera to LF camera");
  app.add_option("--distance", a.distance, "From the middle of the rig to that of the scene");
  app.add_option("--jitter", a.jitter, "Share of the spacing, and degrees, that poses are off by");
  app.add_option("--distortion", a.distortion,
                 "Lens of the LF cameras: OpenCV's k1,k2,p1,p2,k3,k4,k5,k6, or the first of them")
      ->delimiter(',')
      ->expected(1, 8)
      ->check(CLI::Range(-1e6, 1e6));
  app.add_option("--fisheye", a.fisheye, "Fish-eye lens instead: OpenCV's k1,k2,k3,k4")
      ->delimiter(',')
      ->expected(1, 4)
      ->check(CLI::Range(-1e6, 1e6))
      ->excludes("--distortion");
  app.add_option("--fov", a.fov, "Ideal fish-eye lens of this omega (radians) instead")
      ->check(CLI::Range(1e-3, 3.14))
      ->excludes("--distortion")
      ->excludes("--fisheye");
  app.add_option("--format", a.format, "exr, png (8-bit sRGB) or png16 (linear)")
      ->check(CLI::IsMember({"exr", "png", "png16"}));
  app.add_option("--alpha", a.alpha,
                 "Surfaces alone, before a transparent background, with straight or premultiplied "
                 "alpha in the LF images, and premultiplied in true frames; none: no alpha")
      ->check(CLI::IsMember({"none", "straight", "premultiplied"}));
  app.add_flag("--bayer", a.bayer, "Raw-like 16-bit RGGB mosaics instead");
  app.add_option("--noise", a.noise, "With --bayer: standard deviation at radiance 1")
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--samples", a.samples, "Rays per pixel at edges; 0: as the scene recommends")
      ->check(CLI::Range(0, 4096));
  app.add_flag("--calibration-only", a.calibration_only, "Write transforms.json without images");
  app.add_flag(
      "--overwrite", a.overwrite,
      "Replace a light field in DIR that lfsynth has not written, or that was changed since");
  app.add_option("--truth", a.truth, "PATH.yaml whose true thin-lens frames to write");
  app.add_option("--truth-samples", a.truth_samples, "Rays per element of these")
      ->check(CLI::Range(1, 1'000'000));
}

lf::Result<lf::RigOptions> MakeRigOptions(const Arguments& a, const lf::BuiltInScene& scene) {
  lf::RigOptions rig = scene.rig;
  if (a.capture == "band") rig.shape = lf::RigShape::kBand;
  if (a.capture == "hemisphere") rig.shape = lf::RigShape::kHemisphere;
  if (rig.shape == lf::RigShape::kHemisphere && a.spacing)
    return lf::UsageError("--spacing: on a hemisphere it follows from --count and --distance");
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
    return lf::UsageError("--bayer and --format exclude each other: mosaics are 16-bit PNG");
  if (a.alpha != "none" && a.bayer)
    return lf::UsageError("--bayer and --alpha exclude each other: mosaics have no alpha");
  if (a.alpha != "none" && a.scene == "lights")
    return lf::UsageError("--alpha: lights has no surfaces: use another scene");
  if (a.noise > 0 && !a.bayer) return lf::UsageError("--noise is for mosaics: add --bayer");
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

// A wrong -o must not overwrite a light field of others, or one that somebody has edited.
lf::Result<void> CheckMayWrite(const Arguments& a) {
  std::error_code error;
  if (a.overwrite || !std::filesystem::exists(CalibrationIn(a), error)) return {};
  LF_ASSIGN_OR_RETURN(const bool is_ours, lf::IsAsWritten(CalibrationIn(a), lf::kSynthProgram));
  if (is_ours) return {};
  return lf::UsageError(fmt::format(
      "{} was not written by lfsynth, or was changed since: write to another folder, or "
      "replace that light field (--overwrite)",
      CalibrationIn(a).string()));
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfsynth", "Photographs a synthetic scene as a light field.", kExamples);
  program.AddCommonOptions({.threads = true,
                            .seed = "Seed of poses (--jitter) and of noise (--noise)",
                            .progress = true,
                            .quiet = true});
  Arguments a;
  AddOptions(program.app(), a);
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
    // The lock prevents mixing two scenes in one folder.
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
      lf::ProgressMeter meter(style, " images");
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
    lf::ProgressMeter meter(style, " frames");
    return lf::WriteTruth(scene, path.cameras, {a.truth_samples, 0}, light_field.folder / "truth",
                          pool, surroundings, [&](size_t done) {
                            meter.Update(done, path.frame_count(), "truth");
                            return !lf::CatchInterrupts();
                          });
  });
}
