// SPDX-License-Identifier: Apache-2.0
// Makes a light field even in exposure, or merges its brackets, and adds to its report what came of
// it.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/import/check/capture_report.h"
#include "lf/import/check/exif_gains.h"
#include "lf/import/exposure/match_exposure.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// The steps to take, each as the option of lfimport that is named.
struct ExposureSteps {
  bool match = false;           // --match-exposure; not together with gain_from_exif
  bool vignetting = false;      // --vignetting, which needs `match`
  bool gain_from_exif = false;  // --gain-from-exif
  bool mask_clipped = false;    // --mask-clipped
};

// Applies gain_from_exif and mask_clipped to the light field.
//   lights  set to LightOf() of the file of each LF image, for the report. Without gain_from_exif,
//           only files of LF images that share their pose are read; the entries of the others are
//           NaN. Empty for a packed store, or if no file is read
// Returns the gains if gain_from_exif is set. kUsage: one of the two is set for a packed store.
// kInput as for GainFromExif().
Result<std::optional<ExifGains>> StateBrackets(const ExposureSteps& steps, ThreadPool& pool,
                                               LightField* light_field,
                                               std::vector<double>* lights);

// Adds the warning no-f-number if gain_from_exif found no f-number, and no-brackets if mask_clipped
// masks nothing. If `match` is set and the light field masks clipped pixels, first finds the
// report's brackets again, by the matched gains, and removes the warnings that these brackets
// explain. Calls ApplyBrackets().
void WarnOfBrackets(const ExposureSteps& steps, const std::optional<ExifGains>& gains,
                    LightField* light_field, CaptureReport* report);

// Estimates the gains of the LF images and, with vignetting, the falloffs of their lenses, and
// writes them into the light field. Adds warnings to the report about gains and falloffs that stay
// unchanged, and about groups of LF images that were matched separately. Errors as for OpenStore()
// and MatchExposure().
//   progress  as MatchExposureOptions::progress
Result<MatchedExposure> MatchAndApply(
    const ExposureSteps& steps, const std::atomic<bool>& interrupted,
    const std::function<void(size_t done, size_t total)>& progress, ThreadPool& pool,
    LightField* light_field, CaptureReport* report);

}  // namespace lf
