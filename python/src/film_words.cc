// SPDX-License-Identifier: Apache-2.0
#include "python/src/film_words.h"

#include <fmt/format.h>

#include "lf/core/geometry.h"
#include "lf/core/value_named.h"
#include "lf/render/collect/noise_rule.h"
#include "lf/render/collect/sample_rule.h"
#include "lf/render/settings/render_mode.h"

namespace lf::python {
namespace {

// Returns the value, or an error that names the argument and the words that it may be.
template <class T>
Result<T> Known(const std::optional<T>& value, const char* argument, const std::string& found,
                const char* words) {
  if (value) return *value;
  return UsageError(fmt::format("{}=\"{}\": expected one of {}", argument, found, words));
}

std::optional<Estimator> EstimatorOf(const std::string& word) {
  if (word == "auto") return Estimator::kBilinear;
  return ValueNamed(word, {Estimator::kNearest, Estimator::kBilinear});
}

}  // namespace

Result<FilmSettings> FilmSettingsOf(const FilmWords& words) {
  FilmSettings film;
  LF_ASSIGN_OR_RETURN(
      film.mode, Known(RenderModeOf(words.mode), "mode", words.mode, "collect, rebin, hybrid"));
  LF_ASSIGN_OR_RETURN(film.reading.estimator, Known(EstimatorOf(words.estimator), "estimator",
                                                    words.estimator, "auto, nearest, bilinear"));
  LF_ASSIGN_OR_RETURN(
      film.reading.filter,
      Known(ValueNamed(words.filter,
                       {PixelFilter::kAuto, PixelFilter::kNearest, PixelFilter::kBilinear,
                        PixelFilter::kBicubic, PixelFilter::kMosaic, PixelFilter::kPrefiltered}),
            "filter", words.filter, "auto, nearest, bilinear, bicubic, mosaic, prefiltered"));
  LF_ASSIGN_OR_RETURN(film.lens_weights, Known(LensWeightsOf(words.lens_weights), "lens_weights",
                                               words.lens_weights, "auto, none, area, hat"));
  if (words.lf_pixels != "auto") {
    LF_ASSIGN_OR_RETURN(film.reading.footprint,
                        Known(PixelFootprintOf(words.lf_pixels), "lf_pixels", words.lf_pixels,
                              "auto, areas, points"));
  }
  if (words.max_images && *words.max_images == 0)
    return UsageError("max_images=0: expected a number above 0, or None for all LF images");
  if (words.fill < 0 || words.fill > kMostFillRadius_px)
    return UsageError(fmt::format("fill={}: expected a number of elements from 0 to {}", words.fill,
                                  kMostFillRadius_px));
  film.max_image_count = words.max_images;
  film.smooth_below = words.smooth_below;
  film.fill_radius_px = words.fill;
  film.guard = words.guard;
  film.adds_opacity = true;  // for Frame.save(), which may give files alpha
  LF_ASSIGN_OR_RETURN(film.order, Known(ImageOrderOf(words.order), "order", words.order,
                                        "shuffle, round-robin, area"));
  film.seed = words.seed;
  if (words.max_angle_deg) film.max_angle_rad = RadiansFromDegrees(*words.max_angle_deg);
  if (IsNoiseRule(words.stop_when)) {
    LF_ASSIGN_OR_RETURN(film.stop_at_noise, ParseNoiseRule(words.stop_when, "stop_when"));
  } else if (!words.stop_when.empty()) {
    LF_ASSIGN_OR_RETURN(film.stop_at_samples, ParseSampleRule(words.stop_when, "stop_when"));
  }
  return film;
}

}  // namespace lf::python
