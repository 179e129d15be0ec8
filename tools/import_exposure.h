// SPDX-License-Identifier: Apache-2.0
// The options of lfimport for exposure (--match-exposure, --gain-from-exif, --mask-clipped):
// applies them to the light field and reports on them.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/program.h"

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/import/check/capture_report.h"
#include "lf/import/check/exif_gains.h"
#include "lf/import/exposure/match_exposure.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct ExposureArguments {
  bool match = false;
  bool vignetting = false;
  bool gain_from_exif = false;
  bool mask_clipped = false;

  void AddTo(CLI::App& app);
};

// Applies --gain-from-exif and --mask-clipped to the light field, if they are given.
//   lights  set to LightOf() of the file of each LF image, for the report. If --gain-from-exif is
//           not given, only files of LF images that share their pose are read; the entries of the
//           others are NaN. Empty for a packed store, or if no file is read
// Returns the gains if --gain-from-exif is given. kUsage: one of the two options is given for a
// packed store. kInput as for GainFromExif().
Result<std::optional<ExifGains>> StateBrackets(const ExposureArguments& arguments, ThreadPool& pool,
                                               LightField* light_field,
                                               std::vector<double>* lights);

// Adds the warning no-f-number if --gain-from-exif found no f-number, and no-brackets if
// --mask-clipped masks nothing. If --match-exposure is given and the light field masks clipped
// pixels, first finds the report's brackets again, by the matched gains, and removes the warnings
// that these brackets explain. Calls ApplyBrackets().
void WarnOfBracketOptions(const ExposureArguments& arguments, const std::optional<ExifGains>& gains,
                          LightField* light_field, CaptureReport* report);

// Estimates the gains of the LF images and, with --vignetting, the falloffs of their lenses, and
// writes them into the light field. Adds warnings to the report about gains and falloffs that stay
// unchanged, and about groups of LF images that were matched separately. Errors as for
// OpenStore() and MatchExposure().
Result<MatchedExposure> MatchAndApply(const ExposureArguments& arguments,
                                      const CommonOptions& common,
                                      const std::atomic<bool>& interrupted, ThreadPool& pool,
                                      LightField* light_field, CaptureReport* report);

// Returns the line `brackets` of the report, such as "25 poses x 3 exposures, -2, 0 and +2 stops by
// lf_gain".
std::string BracketsText(const FoundBrackets& brackets);
// Returns the line `gains` of the report: the range of the gains that --gain-from-exif computed.
std::string ExifGainsText(const ExifGains& gains);

nlohmann::ordered_json BracketsJson(const FoundBrackets& brackets);
nlohmann::ordered_json ExifGainsJson(const ExifGains& gains);

// Returns the line `exposure` of the report, such as "81 of 81 images matched by ...".
std::string ExposureText(const MatchedExposure& exposure);
// Returns the line `seams` of the report: how much neighbouring images differ before and after they
// are matched.
std::string SeamsText(const MatchedExposure& exposure);
// Returns the line `falloff` of the report: the share of the light that is left in the corners.
std::string FalloffText(const FoundFalloff& falloff);

nlohmann::ordered_json ExposureJson(const MatchedExposure& exposure);

}  // namespace lf
