// lfimport --match-exposure: the options, the step, and what the report says of it.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/common/program.h"

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/exposure/match_exposure.h"
#include "lf/import/capture_report.h"

namespace lf {

struct ExposureArguments {
  bool match = false;
  bool vignetting = false;

  void AddTo(CLI::App& app);
};

// Estimates the exposure and writes it into the light field; warns of what was left alone.
Result<MatchedExposure> MatchAndApply(const ExposureArguments& arguments,
                                      const CommonOptions& common,
                                      const std::atomic<bool>& interrupted, ThreadPool& pool,
                                      LightField* light_field, CaptureReport* report);

// The line `exposure`, and what follows it: "81 of 81 images matched, ...".
std::string ExposureText(const MatchedExposure& exposure);
// The line `seams`.
std::string SeamsText(const MatchedExposure& exposure);
// The line `falloff`.
std::string FalloffText(const FoundFalloff& falloff);

nlohmann::ordered_json ExposureJson(const MatchedExposure& exposure);

}  // namespace lf
