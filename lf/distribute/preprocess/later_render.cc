// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/later_render.h"

#include <fmt/format.h>

#include "lf/render/collect/frame_lens.h"
#include "lf/render/settings/interpolation.h"

namespace lf {

FilmSettings LaterRender(FilmSettings film, const LightField& light_field) {
  film.reading.filter = FilterOf(film.reading.filter, light_field.encoding);
  if (film.Rebins()) film.rebin.interpolation = InterpolationOf(film);
  // Cells alone are not weighted.
  if (!HasLensWeights(film) && film.lens_weights == LensWeights::kAuto)
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
  needs.rebin.interpolation = film.rebin.interpolation;
  needs.max_image_count = film.max_image_count;
  needs.guard = film.guard && !KeepsCells(film) && HasVirtual(light_field);
  return needs;
}

Result<void> CheckLaterRender(const LightField& light_field, const CameraPath& path,
                              std::span<const FrameId> frames, const FilmSettings& film,
                              const NeedsOptions& needs) {
  LF_RETURN_IF_ERROR(CheckMode(film));
  LF_RETURN_IF_ERROR(CheckInterpolation(film));
  LF_RETURN_IF_ERROR(CheckOpacity(light_field.encoding, film));
  LF_RETURN_IF_ERROR(CheckLenses(path.cameras, film));
  LF_RETURN_IF_ERROR(CheckShutter(path.shutter.exists(), film, needs.guard));
  LF_RETURN_IF_ERROR(CheckMaxImages(film));
  if (!HasLensWeights(film) && film.lens_weights != LensWeights::kNone &&
      film.lens_weights != LensWeights::kAuto)
    return UsageError(fmt::format(
        "{{lens_weights {}}} cannot be used with {{mode rebin}} and {{interpolation cells}}, which "
        "collect no rays to be weighted: leave it out, or use {{interpolation pixels}}",
        NameOf(film.lens_weights)));
  if (film.lens_weights == LensWeights::kArea)
    for (const FrameId frame : frames)
      for (const RenderCamera& camera : path.Instants(frame))
        LF_RETURN_IF_ERROR(CheckHasArea(camera, frame));
  return {};
}

}  // namespace lf
