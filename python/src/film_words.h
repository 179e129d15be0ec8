// SPDX-License-Identifier: Apache-2.0
// The options of a film as Python's keyword arguments.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/render/settings/film_settings.h"

namespace lf::python {

// Each member has the meaning and the default of the option of lfrenderer with this name. The
// default of stop_when is no rule; max_images and max_angle_deg are unset if there is no limit.
struct FilmWords {
  std::string mode = "collect", estimator = "auto", filter = "auto", lens_weights = "auto",
              lf_pixels = "auto", order = "shuffle", stop_when;
  std::optional<size_t> max_images;
  std::optional<double> max_angle_deg;
  uint64_t seed = 0;
  uint32_t smooth_below = 0;
  int fill = kFillRadius_px;
  bool guard = true;
};

// Returns the settings of the film. kUsage: a word is not one of those that exist, or a number is
// out of range.
Result<FilmSettings> FilmSettingsOf(const FilmWords& words);

}  // namespace lf::python
