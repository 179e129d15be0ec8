// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/check_film_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/pipeline/resolved_settings.h"
#include "lf/render/settings/interpolation.h"

namespace lf {
namespace {

// Checks that the viewing direction of every frame is within 60 degrees of --slab-forward, because
// only rays in about this direction meet the st plane of the slab before the uv plane.
Result<void> CheckSlab(const Package& package, const FilmSettings& film,
                       const std::vector<FrameId>& frames) {
  constexpr double kMost_deg = 60;
  if (!film.Rebins() || !film.rebin.slab.forward_world) return {};
  const Vec3& given = *film.rebin.slab.forward_world;
  if (!(given.norm() > 0))
    return UsageError(
        "{slab_forward 0 0 0}: expected a direction, with at least one number other than 0");
  const Vec3 forward = given.normalized();
  for (const FrameId frame : frames) {
    const double cosine = forward.dot(package.path.Camera(frame).pinhole.ForwardWorld());
    const double off_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / kPi;
    if (off_deg > kMost_deg)
      return UsageError(fmt::format(
          "{{slab_forward {} {} {}}}: the viewing direction of frame {} is {:.0f} degrees away; "
          "expected a direction within {:.0f} degrees of the viewing directions of all frames",
          given.x(), given.y(), given.z(), frame.value, off_deg, kMost_deg));
  }
  return {};
}

// Checks that light field and path agree about the times of a light field video.
Result<void> CheckRecordingTimes(const Package& package, const FilmSettings& film) {
  const LightField& light_field = package.light_field;
  const std::span<const RenderCamera> cameras = package.path.AllInstants();
  const auto moves = [](const RenderCamera& camera) { return camera.recording_time.has_value(); };
  const bool has_one_time = light_field.slice_times.size() < 2;
  if (has_one_time && std::any_of(cameras.begin(), cameras.end(), moves))
    return UsageError(
        "the path moves through time (its key time), but the light field shows one time: open the "
        "times of the path, or remove the key time from the path");
  if (has_one_time) return {};
  if (!std::all_of(cameras.begin(), cameras.end(), moves))
    return UsageError(
        "several times of a light field video are open, and the path does not tell which of them "
        "its frames show: state its key time, or open one time ({time})");
  if (light_field.encoding.masks_clipped)
    return UsageError(
        "the LF images are exposures of the same poses (lf_clipped), which cannot be told from "
        "those "
        "of other times: render each time as a film of its own ({time})");
  if (KeepsCells(film))
    return UsageError(fmt::format(
        "{}: the frames of a path that moves through time cannot share cells: use {} or {}, or "
        "render each time as a film of its own ({{time}})",
        CellsInWords(film), PixelsInstead(film), CollectInstead(film)));
  return {};
}

// Checks that a shard has no option that needs the rays of all shards. What shards collect from
// kept pixels adds, unless pixels between them are interpolated.
Result<void> CheckShard(const FilmSettings& film) {
  if (!film.shard) return {};
  const bool adds = !film.Rebins() || (KeepsPixels(film) && film.rebin.kept != KeptRays::kEdges);
  if (adds && !film.stop_when.samples && !film.require.samples && !film.MeasuresNoise()) return {};
  if (KeepsCells(film)) {
    std::vector<std::string> also;
    if (film.rebin.kept == KeptRays::kEdges) also.push_back("{kept edges}");
    return UsageError(
        fmt::format("{{shard}} renders only a part of the LF images, but {} needs all of them: use "
                    "{} or {}, or leave {{shard}} out",
                    CellsInWords(film), PixelsInstead(film, also), CollectInstead(film)));
  }
  return UsageError(
      "{shard} renders only a part of the LF images, but {mode rebin} and {mode hybrid} with "
      "{kept edges}, {stop_when} and {require} need all of them: leave out these options, or "
      "{shard}");
}

Result<void> CheckRebinnedRays(const Package& package, const FilmSettings& film,
                               const std::vector<FrameId>& frames) {
  if (film.mode == RenderMode::kRebin && film.CountsRays())
    return UsageError(
        "{mode rebin} collects no rays, which \"samples>=N\" ({stop_when}, {require}) and "
        "{smooth_below} would count: leave these options out, use \"noise<=X\", or use "
        "{mode hybrid}");
  LF_RETURN_IF_ERROR(CheckInterpolation(film));
  LF_RETURN_IF_ERROR(CheckOpacity(package.light_field.encoding, film));
  LF_RETURN_IF_ERROR(CheckLenses(package.path.cameras, film));
  LF_RETURN_IF_ERROR(CheckShutter(package.path.shutter.exists(), film,
                                  film.guard && package.whole_virtual_count > 0));
  LF_RETURN_IF_ERROR(CheckSlab(package, film, frames));
  if (film.Rebins() && !package.choices.has_neighbours)
    return UsageError(fmt::format(
        "{{mode {}}}: package {} lacks the LF cameras beside the lens, because it was made "
        "with {{lfpreprocessor lens_weights none}}: make the package again with "
        "{{mode {}}}, or without {{lens_weights none}}",
        NameOf(film.mode), package.name, NameOf(film.mode)));
  LF_RETURN_IF_ERROR(CheckMaxImages(film));
  if (!film.rebin.reparameterise && film.rebin.query.lens_sets > 1)
    return UsageError(
        "{reparameterise off} cannot be used with {lens_sets} above 1: leave one of them out");
  if (film.rebin.nearest > 0 && film.back_end != CollectBackEnd::kReference)
    return UsageError(
        "{nearest} can only be used with {back_end reference}, which is far slower: add "
        "{back_end reference}, or leave {nearest} out");
  return {};
}

Result<void> CheckLensWeights(const Package& package, const FilmSettings& film,
                              const std::vector<FrameId>& frames) {
  if (film.lens_weights == LensWeights::kNone) {
    for (const FrameId frame : frames)
      if (package.path.Camera(frame).transmission)
        return UsageError(
            "the lens has a transmission (lens.transmission in the path), which lens weights "
            "state: leave out {lens_weights none} and options that count rays "
            "(\"samples>=N\", {smooth_below}), or leave the transmission out");
    return {};
  }
  const char* const name = NameOf(film.lens_weights);
  if (!package.choices.has_neighbours)
    return UsageError(
        fmt::format("{{lens_weights {}}}: package {} lacks the LF cameras beside the lens, because "
                    "it was made with {{lfpreprocessor lens_weights none}}: make the package again "
                    "without this option, or give {{lfrenderer lens_weights none}}",
                    name, package.name));
  if (film.CountsRays())
    return UsageError(fmt::format(
        "{{lens_weights {}}}: sums of weights replace the ray counts that \"samples>=N\" "
        "({{stop_when}}, {{require}}) and {{smooth_below}} need: leave these options out, "
        "use \"noise<=X\", or use {{lens_weights none}}",
        name));
  if (film.lens_weights == LensWeights::kArea)
    for (const FrameId frame : frames)
      for (const RenderCamera& camera : package.path.Instants(frame))
        LF_RETURN_IF_ERROR(CheckHasArea(camera, frame));
  return {};
}

// Checks that the frames of a densified light field can be guarded.
Result<void> CheckGuard(const Package& package, const FilmSettings& film) {
  constexpr const char* kRemedy = "add {guard off}";
  for (const RenderCamera& camera : package.path.cameras)
    if (camera.surface)
      return UsageError(fmt::format(
          "the light field is densified, and frames with a focal surface (focus.surface in the "
          "path) cannot be guarded: {}",
          kRemedy));
  if (KeepsCells(film))
    return UsageError(fmt::format(
        "{}: the light field is densified, and cells cannot be guarded: use {} or {}, or {}",
        CellsInWords(film), PixelsInstead(film), CollectInstead(film), kRemedy));
  if (package.light_field.encoding.bayer != BayerPattern::kNone)
    return UsageError(fmt::format(
        "the light field is densified, and frames of mosaics cannot be guarded: {}", kRemedy));
  if (!package.choices.has_neighbours)
    return UsageError(fmt::format(
        "the light field is densified, but package {} lacks the LF cameras beside the lens, which "
        "the guard needs, because it was made with {{lfpreprocessor guard off}}: make it again "
        "without this option, or {}",
        package.name, kRemedy));
  return {};
}

// Checks that the first LF images of a frame are a sample of all of them if a rule reads them as
// one.
Result<void> CheckOrder(const Package& package, const FilmSettings& film) {
  if (!TakesNeighboursTogether(film.order)) return {};
  const bool samples = film.order == ImageOrder::kGroups && film.stop_when.samples;
  const bool is_part = film.stop_when.noise || film.max_image_count;
  if (!samples && !(film.MeasuresNoise() && is_part)) return {};
  return UsageError(fmt::format(
      "{{order {}}}: the first LF images of a frame are neighbours, so that {} ({{stop_when}}, "
      "{{require}}) would take it for finished while its lens has holes: {}",
      NameOf(film.order), samples ? "\"samples>=N\"" : "\"noise<=X\"",
      package.name.empty()
          ? "use {order spread}, or leave the rule out"
          : "make the packages again with {lfpreprocessor order spread}, or leave the rule out"));
}

}  // namespace

Result<void> CheckFilmSettings(const Package& package, const FilmSettings& options,
                               const std::vector<FrameId>& given) {
  const FilmSettings film = Resolved(options, package);
  // Advice about cells is made for the settings that were given.
  FilmSettings unresolved = options;
  unresolved.max_image_count = film.max_image_count;
  const std::vector<FrameId> frames = given.empty() ? package.FrameIds() : given;
  LF_RETURN_IF_ERROR(CheckMode(unresolved));
  LF_RETURN_IF_ERROR(CheckRebinnedRays(package, unresolved, frames));
  const std::optional<size_t>& most = package.choices.max_image_count;
  if (most && *film.max_image_count > *most)
    return UsageError(fmt::format(
        "package {} was made with {{max_images {}}}, and contains no more LF images of any "
        "frame: give lfrenderer at most this {{max_images}}, or make the package again",
        package.name, *most));
  LF_RETURN_IF_ERROR(CheckOrder(package, film));
  LF_RETURN_IF_ERROR(CheckRecordingTimes(package, unresolved));
  LF_RETURN_IF_ERROR(CheckShard(unresolved));
  if (package.whole_virtual_count > 0 && film.guard)
    LF_RETURN_IF_ERROR(CheckGuard(package, unresolved));
  if (package.whole_virtual_count > 0 && !film.guard &&
      (film.stop_when.samples || film.require.samples))
    return UsageError(
        "{stop_when} and {require} samples>=N count the rays of recorded LF images alone, but "
        "frames of a densified light field add the rays of virtual LF images to the same counts: "
        "use \"noise<=X\", or leave out {guard off}");
  return CheckLensWeights(package, film, frames);
}

}  // namespace lf
