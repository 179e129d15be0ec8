// lfimport's options for exposure (--match-exposure, --gain-from-exif, --mask-clipped): what they
// do to the light field, and what the report says of it.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/program.h"

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/exposure/match_exposure.h"
#include "lf/import/capture_report.h"
#include "lf/import/exif_gains.h"

namespace lf {

struct ExposureArguments {
  bool match = false;
  bool vignetting = false;
  bool gain_from_exif = false;
  bool mask_clipped = false;

  void AddTo(CLI::App& app);
};

// Writes gains from Exif data into the light field, and that clipped pixels are masked, as asked
// for.
//   lights  becomes LightOf() the files, for the report: of all LF images, or of those that share
//           their pose; NaN for the others, empty if there are none
// Returns the gains, if they were asked for. kUsage for a packed store; kInput as GainFromExif().
Result<std::optional<ExifGains>> StateBrackets(const ExposureArguments& arguments, ThreadPool& pool,
                                               LightField* light_field,
                                               std::vector<double>* lights);

// Adds the warnings no-f-number, and no-brackets where --mask-clipped masks nothing.
void WarnOfBracketOptions(const ExposureArguments& arguments, const std::optional<ExifGains>& gains,
                          LightField* light_field, CaptureReport* report);

// Estimates the exposure and writes it into the light field; warns of what was left alone.
Result<MatchedExposure> MatchAndApply(const ExposureArguments& arguments,
                                      const CommonOptions& common,
                                      const std::atomic<bool>& interrupted, ThreadPool& pool,
                                      LightField* light_field, CaptureReport* report);

// The line `brackets`: "25 poses x 3 exposures, -2, 0 and +2 stops by lf_gain".
std::string BracketsText(const FoundBrackets& brackets);
// The line `gains`.
std::string ExifGainsText(const ExifGains& gains);

nlohmann::ordered_json BracketsJson(const FoundBrackets& brackets);
nlohmann::ordered_json ExifGainsJson(const ExifGains& gains);

// The line `exposure`, and what follows it: "81 of 81 images matched, ...".
std::string ExposureText(const MatchedExposure& exposure);
// The line `seams`.
std::string SeamsText(const MatchedExposure& exposure);
// The line `falloff`.
std::string FalloffText(const FoundFalloff& falloff);

nlohmann::ordered_json ExposureJson(const MatchedExposure& exposure);

}  // namespace lf
