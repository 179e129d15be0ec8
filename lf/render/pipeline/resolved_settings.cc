// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/resolved_settings.h"

#include "lf/render/settings/interpolation.h"

namespace lf {

FilmSettings Resolved(FilmSettings settings, const Package& package) {
  settings.order = package.choices.order;
  settings.seed = package.choices.seed;
  settings.rebin.rebin.seed = settings.rebin.query.seed = settings.seed;
  settings.max_angle_rad = package.choices.max_angle_rad;
  if (settings.Rebins()) settings.rebin.interpolation = InterpolationOf(settings);
  if (!HasLensWeights(settings) ||
      (settings.lens_weights == LensWeights::kAuto && settings.CountsRays()))
    settings.lens_weights = LensWeights::kNone;
  settings.reading.filter = FilterOf(settings.reading.filter, package.light_field.encoding);
  settings.guard = settings.guard && package.whole_virtual_count > 0;
  if (!settings.max_image_count) settings.max_image_count = package.choices.max_image_count;
  return settings;
}

NeedsOptions NeedsOfFilm(const Package& package, const FilmSettings& film,
                         const WorkSettings& work) {
  NeedsOptions needs;
  needs.select.reach = ReachOf(film.reading);
  needs.select.max_angle_rad = film.max_angle_rad;
  needs.select.interrupted = work.stop;
  needs.lens_weights = film.lens_weights;
  needs.max_image_count = film.max_image_count;
  needs.mode = film.mode;
  needs.rebin = film.rebin;
  needs.guard = film.guard && !KeepsCells(film) && package.whole_virtual_count > 0;
  return needs;
}

}  // namespace lf
