// SPDX-License-Identifier: Apache-2.0
// Estimates how unevenly the LF images of a light field are exposed, and how much light their
// lenses lose towards the corners, from places that neighbouring LF images both show.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/vignetting.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct MatchExposureOptions {
  bool vignetting = false;  // true: falloffs are estimated; false: the light field's are kept
  // Memory for small views of all LF images (exposure_views.h). Narrower views are used if the
  // widest do not fit.
  size_t memory_bytes = size_t{2} << 30;
  const std::atomic<bool>* interrupted = nullptr;  // true ends the matching early; null: never
  std::function<void(size_t done, size_t total)> progress;
};

struct FoundFalloff {
  // Least and largest share of the light, over all falloffs, that is left in the image corner
  // farthest from the principal point.
  double corner_min = 1, corner_max = 1;
  double reach = 0;         // radius r (camera/vignetting.h) that a tenth of the samples exceeds
  size_t camera_count = 0;  // number of estimated falloffs
};

struct MatchedExposure {
  std::vector<ChannelGains> gains;      // gains for each of LightField::cameras
  std::vector<Vignetting> falloffs;     // falloff for each of LightField::intrinsics
  float least_gain = 1, most_gain = 1;  // range of the gains of LF images that were matched
  std::optional<FoundFalloff> falloff;  // none: falloffs were not requested, or are not believable
  // Mean relative difference of the light of the same place in two neighbouring LF images, which is
  // the strength of seams. `before` uses the exposure of the calibration, `after` the matched one.
  double step_before = 0, step_after = 0;
  size_t sample_count = 0;            // ExposureFit::sample_count (fit_exposure.h)
  size_t component_count = 0;         // number of components (MatchExposure())
  std::vector<LfImageId> left_alone;  // LF images whose gains cannot be fitted and are kept
  std::vector<LfImageId> unreadable;  // LF images that cannot be read; their gains are kept
};

// Returns a copy of the light field that has no gains and falloffs and masks no clipped pixels.
// MatchExposure() reads a store of this copy.
LightField WithoutExposure(const LightField& light_field);

// For each LF image, finds the depths of its textured places, at which the LF images around it
// agree (focus/place_depth.h). Compares the light of each place with the light that these LF
// images, and the six whose LF cameras are nearest, show there. Dark, clipped and masked pixels are
// not used, and FitExposure() gives outliers no weight. A component is a set of LF images that are
// connected by overlaps; the geometric mean of its gains is 1 in each channel. Each entry of
// LightField::intrinsics has its own falloff; if there are fewer than eight LF images per entry on
// average, all entries with the same image size share a falloff. Each LF image is loaded once.
//   store  the store of WithoutExposure(light_field), with Mosaics::kToRgb
// kInput: there are too many images for the memory; or the gains of fewer than half of the readable
// LF images can be estimated, because they do not overlap enough, or because the light on the scene
// changes from one image to the next. kInterrupted: `interrupted` is true.
Result<MatchedExposure> MatchExposure(const LightField& light_field, const LfImageStore& store,
                                      const MatchExposureOptions& options, ThreadPool& pool);

// Writes gains and falloffs into the light field, and raises max_radiance of integer files so that
// they clip no recorded light.
void ApplyExposure(const MatchedExposure& matched, LightField* light_field);

}  // namespace lf
