// SPDX-License-Identifier: Apache-2.0
// The lines and the JSON of exposure in the report on a light field. Internal to this folder.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lf/import/check/capture_report.h"
#include "lf/import/check/exif_gains.h"
#include "lf/import/exposure/match_exposure.h"

namespace lf {

// Returns the line `brackets` of the report, such as "25 poses x 3 exposures, -2, 0 and +2 stops by
// lf_gain".
std::string BracketsText(const FoundBrackets& brackets);
// Returns the line `gains` of the report: the range of the gains that were taken from the files.
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
