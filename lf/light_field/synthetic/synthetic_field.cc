// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/synthetic_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/light_field/synthetic/built_in_scenes.h"
#include "lf/light_field/synthetic/write_light_field.h"
#include "lf/light_field/synthetic/write_truth.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace {

Result<RigOptions> RigOf(const SyntheticFieldOptions& a, const BuiltInScene& scene) {
  RigOptions rig = scene.rig;
  if (a.capture == "band") rig.shape = RigShape::kBand;
  if (a.capture == "hemisphere") rig.shape = RigShape::kHemisphere;
  if (rig.shape == RigShape::kHemisphere && a.spacing)
    return UsageError(
        "{spacing} cannot be used with {capture hemisphere}, where {count} and {distance} "
        "determine it: leave it out");
  if (a.count > 0) rig.count = a.count;
  rig.spacing_w = a.spacing.value_or(rig.spacing_w);
  rig.distance_w = a.distance.value_or(rig.distance_w);
  rig.jitter = a.jitter;
  rig.seed = a.seed;
  return rig;
}

Distortion DistortionOf(const SyntheticFieldOptions& a) {
  Distortion distortion;
  const auto set = [&](DistortionModel model, const std::vector<double>& parameters) {
    if (parameters.empty()) return;
    distortion.model = model;
    std::copy(parameters.begin(), parameters.end(), distortion.parameters.begin());
  };
  set(DistortionModel::kRadialTangential, a.distortion);
  set(DistortionModel::kFisheye, a.fisheye);
  if (a.fov > 0) set(DistortionModel::kFov, {a.fov});
  return distortion;
}

Result<LfImageFormat> FormatOf(const SyntheticFieldOptions& a) {
  if (a.bayer && a.format != "exr")
    return UsageError(
        "{bayer} and {format} cannot be combined, because mosaics are always 16-bit PNG: leave one "
        "out");
  if (a.alpha != "none" && a.bayer)
    return UsageError(
        "{bayer} and {alpha} cannot be combined, because mosaics have no alpha: leave one out");
  if (a.alpha != "none" && a.scene == "lights")
    return UsageError(
        "{alpha} cannot be used with the scene lights, which has no surfaces: use another scene, "
        "or leave {alpha} out");
  if (a.noise > 0 && !a.bayer)
    return UsageError("{noise} can only be used with mosaics: add {bayer}, or leave {noise} out");
  if (a.bayer) return LfImageFormat::kBayer;
  if (a.format == "png") return LfImageFormat::kPng;
  return a.format == "png16" ? LfImageFormat::kPng16 : LfImageFormat::kExr;
}

std::filesystem::path CalibrationIn(const SyntheticFieldOptions& a) {
  return std::filesystem::path(a.output) / "transforms.json";
}

// kUsage if the folder holds a light field, and `overwrite` is false.
Result<void> CheckMayReplace(const SyntheticFieldOptions& a) {
  if (a.overwrite) return {};
  std::error_code error;
  const bool is_native = std::filesystem::exists(CalibrationIn(a), error);
  const bool is_other = !is_native && a.holds_light_field && a.holds_light_field(a.output);
  if (!is_native && !is_other) return {};
  return UsageError(
      is_native
          ? fmt::format("{}: exists already: give another folder, or replace this light field with "
                        "{{overwrite}}",
                        CalibrationIn(a).string())
          : fmt::format("{}: holds a light field that lfsynth did not write, and that a "
                        "transforms.json would hide: give another folder, or write beside it with "
                        "{{overwrite}}",
                        a.output));
}

// Returns the paths of the LF images of the light field that is replaced, if lfsynth wrote it and
// nobody changed it since.
Result<std::vector<std::filesystem::path>> ImagesToReplace(const SyntheticFieldOptions& a) {
  std::vector<std::filesystem::path> images;
  std::error_code error;
  if (!std::filesystem::exists(CalibrationIn(a), error)) return images;
  LF_ASSIGN_OR_RETURN(const bool is_ours, IsAsWritten(CalibrationIn(a), kSynthProgram));
  if (!is_ours) return images;
  LF_ASSIGN_OR_RETURN(const LightField earlier, ReadTransformsJson(CalibrationIn(a)));
  for (uint32_t i = 0; i < earlier.size(); ++i) images.push_back(earlier.ImagePath({i}));
  return images;
}

// kUsage if an output, or an LF image that is removed, is one of the inputs.
Result<void> CheckKeepsInputs(const SyntheticFieldOptions& a, const LightField& light_field,
                              const std::vector<std::filesystem::path>& earlier,
                              size_t frame_count) {
  if (a.inputs.empty()) return {};
  std::vector<OutputFile> outputs = {{CalibrationIn(a), "the calibration"}};
  for (uint32_t i = 0; i < light_field.size() && !a.calibration_only; ++i)
    outputs.emplace_back(light_field.ImagePath({i}), "an LF image");
  for (size_t i = 0; i < frame_count; ++i)
    outputs.emplace_back(TruthPath(light_field.folder / "truth", a.first_truth_frame + i),
                         "a frame");
  LF_RETURN_IF_ERROR(CheckOutputFiles(std::move(outputs), a.inputs));
  // LF images that are removed are checked apart, because some are also outputs.
  return CheckOutputFiles({earlier.begin(), earlier.end()}, a.inputs);
}

// Removes those LF images of an earlier light field that the new one does not replace.
Result<void> RemoveOthers(const std::vector<std::filesystem::path>& earlier,
                          const LightField& light_field) {
  std::set<std::filesystem::path> kept;
  for (uint32_t i = 0; i < light_field.size(); ++i) kept.insert(light_field.ImagePath({i}));
  for (const std::filesystem::path& path : earlier) {
    std::error_code error;
    if (!kept.contains(path) && !std::filesystem::remove(path, error) && error)
      return OutputError(fmt::format("{}: the older LF image cannot be removed: {}", path.string(),
                                     error.message()));
  }
  return {};
}

}  // namespace

Result<void> WriteSyntheticField(const SyntheticFieldOptions& options, ThreadPool& pool,
                                 const SyntheticProgress& keep_going) {
  const BuiltInScene* const built_in = FindBuiltInScene(options.scene);
  if (built_in == nullptr)
    return UsageError(
        fmt::format("scene {}: expected one of still-life, lights, chart, foliage", options.scene));
  LF_ASSIGN_OR_RETURN(const LfImageFormat format, FormatOf(options));
  LF_ASSIGN_OR_RETURN(const RigOptions rig, RigOf(options, *built_in));
  LF_ASSIGN_OR_RETURN(const std::vector<RigidTransform> poses, MakeRig(rig));
  const std::vector<RenderCamera>& truth = options.truth_cameras;
  const auto instants = static_cast<size_t>(options.truth_instants);
  // The lock keeps two processes from mixing their scenes in one folder.
  LF_ASSIGN_OR_RETURN(const FileLock lock, LockOutputFolder(options.output));
  LF_RETURN_IF_ERROR(CheckMayReplace(options));
  LF_ASSIGN_OR_RETURN(const std::vector<std::filesystem::path> earlier, ImagesToReplace(options));
  const auto [width_px, height_px] =
      options.size_px.value_or(std::pair(built_in->width_px, built_in->height_px));
  Intrinsics intrinsics = IntrinsicsFor(*built_in, width_px, height_px);
  intrinsics.distortion = DistortionOf(options);
  LightField light_field =
      DescribeLightField(poses, intrinsics, format, built_in->max_radiance, options.output);
  light_field.encoding.alpha = AlphaMeaningOf(options.alpha);
  const size_t frame_count = truth.size() / instants;
  LF_RETURN_IF_ERROR(CheckKeepsInputs(options, light_field, earlier, frame_count));
  const Surroundings surroundings =
      light_field.encoding.AlphaIsLight() ? Surroundings::kTransparent : Surroundings::kShown;
  const Scene scene(built_in->describe());
  if (options.calibration_only) {
    LF_RETURN_IF_ERROR(WriteTransformsJson(light_field, CalibrationIn(options), kSynthProgram));
  } else {
    LF_RETURN_IF_ERROR(RemoveOthers(earlier, light_field));
    const int samples = options.samples > 0 ? options.samples : built_in->samples;
    const auto tell = [&](size_t done) { return keep_going(done, poses.size(), false); };
    LF_RETURN_IF_ERROR(WriteLightField(scene, light_field,
                                       {format, samples, options.noise, options.seed, tell}, pool));
  }
  LogInfo("{}: {} LF cameras, {:.4g} apart", options.output, poses.size(), RigPitch(rig));
  if (truth.empty()) return {};
  return WriteTruth(
      scene, truth, {options.truth_samples, 0}, light_field.folder / "truth", pool, surroundings,
      [&](size_t done) { return keep_going(done, frame_count, true); }, instants,
      options.first_truth_frame);
}

}  // namespace lf
