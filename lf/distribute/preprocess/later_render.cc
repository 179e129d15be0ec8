// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/later_render.h"

#include <fmt/format.h>

#include "lf/render/collect/frame_lens.h"

namespace lf {

FilmSettings LaterRender(FilmSettings film, const LightField& light_field) {
  film.reading.filter = FilterOf(film.reading.filter, light_field.encoding);
  // Rebinned rays alone are not weighted.
  if (film.mode == RenderMode::kRebin && film.lens_weights == LensWeights::kAuto)
    film.lens_weights = LensWeights::kNone;
  return film;
}

NeedsOptions NeedsOfLaterRender(const FilmSettings& film, const LightField& light_field,
                                const std::atomic<bool>* interrupted) {
  NeedsOptions needs;
  needs.select.reach = WidestReachOf(film.reading.estimator, light_field.encoding);
  needs.select.max_angle_rad = film.max_angle_rad;
  needs.select.interrupted = interrupted;
  needs.lens_weights = film.lens_weights;
  needs.mode = film.mode;
  needs.max_image_count = film.max_image_count;
  needs.guard = film.guard && film.mode == RenderMode::kCollect && HasVirtual(light_field);
  return needs;
}

Result<void> CheckLaterRender(const LightField& light_field, const CameraPath& path,
                              std::span<const FrameId> frames, const FilmSettings& film,
                              const NeedsOptions& needs) {
  LF_RETURN_IF_ERROR(CheckOpacity(light_field.encoding, film.mode));
  LF_RETURN_IF_ERROR(CheckLenses(path.cameras, film.mode));
  LF_RETURN_IF_ERROR(CheckShutter(path.shutter.exists(), film.mode, needs.guard));
  if (film.Rebins() && film.max_image_count)
    return UsageError(
        "{max_images} cannot be used with {mode rebin} or hybrid, in which all frames share the "
        "rebinned rays of all LF images: leave it out, or use {mode collect}");
  if (!film.Collects() && film.lens_weights != LensWeights::kNone)
    return UsageError(fmt::format(
        "{{lens_weights {}}} cannot be used with {{mode rebin}}, which collects no rays to "
        "be weighted: leave it out",
        NameOf(film.lens_weights)));
  if (film.lens_weights == LensWeights::kArea)
    for (const FrameId frame : frames)
      for (const RenderCamera& camera : path.Instants(frame))
        LF_RETURN_IF_ERROR(CheckHasArea(camera, frame));
  return {};
}

}  // namespace lf
