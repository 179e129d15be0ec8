// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/film_options.h"

namespace lf {

FilmOptions Resolved(FilmOptions options, const Package& package) {
  if (options.mode == RenderMode::kRebin ||
      (options.lens_weights == LensWeights::kAuto && options.CountsRays()))
    options.lens_weights = LensWeights::kNone;
  options.reading.filter =
      FilterOf(options.reading.filter, package.light_field.encoding, options.CountsRays());
  if (!options.max_image_count) options.max_image_count = package.choices.max_image_count;
  return options;
}

NeedsOptions NeedsOfFilm(const Package& package, const FilmOptions& film, const WorkOptions& work) {
  NeedsOptions needs;
  needs.select.reach = ReachOf(film.reading);
  needs.select.max_angle_rad = package.choices.max_angle_rad;
  needs.select.interrupted = work.stop;
  needs.lens_weights = film.lens_weights;
  needs.max_image_count = film.max_image_count;
  needs.mode = film.mode;
  needs.rebin = film.rebin;
  needs.guard = film.guard && film.mode == RenderMode::kCollect && package.whole_virtual_count > 0;
  return needs;
}

}  // namespace lf
