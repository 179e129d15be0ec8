// SPDX-License-Identifier: Apache-2.0
// The report of lfimport (doc/formats/import_report.md).
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/import/agreement/agreement.h"
#include "lf/import/check/capture_report.h"
#include "lf/import/check/check_images.h"
#include "lf/import/check/exif_gains.h"
#include "lf/import/check/find_profiles.h"
#include "lf/import/exposure/match_exposure.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// The footprint of LF pixels, and who says so.
struct FootprintFacts {
  PixelFootprint footprint = PixelFootprint::kArea;
  bool is_stated = false;  // true: by the calibration (lf_pixels); false: measured in three images
};

struct ImportReport {
  std::string light_field;  // LIGHTFIELD as the user typed it
  std::string first_image;  // path of the first image's file, which shows where images were found
  CaptureReport capture;
  std::optional<ImageFaults> faults;  // nullopt: the files were not checked
  // Facts about a light field video, and the recording times that are open; nullopt and empty for
  // other light fields.
  std::optional<VideoFacts> video;
  std::vector<double> shown_times;
  std::optional<StoreFilms> films;  // nullopt unless a packed store was encoded for certain films
  size_t predicted_count =
      0;  // number of LF images of a packed store that are predicted from others
  size_t excluded_count = 0;  // number of LF images that were left out on purpose
  // nullopt: the files were not checked, or faults of the files forbid that anything is written
  std::optional<FootprintFacts> pixels;
  std::optional<Agreement> agreement;       // nullopt as `pixels`
  std::optional<FoundProfile> profile;      // nullopt: the files were not checked, or have none
  std::optional<ExifGains> exif_gains;      // nullopt: gains were not taken from the files
  std::optional<MatchedExposure> exposure;  // nullopt: exposures were not matched
  std::string written;                      // path of the transforms.json; "": nothing was written
  std::string next;  // line with the command of the next step; "": the report ends with warnings
};

// Adds the warnings missing-images and broken-images if report->faults, which must be set, contains
// such LF images.
void WarnOfFaults(const LightField& light_field, ImportReport* report);

// Judges whether images and poses belong together, sets report->agreement, and adds the warning
// poses-disagree if they do not.
//   repair_call  returns the call of lfimport that applies the words of a repair; "": there is none
// Errors are those of JudgeAgreement().
Result<void> JudgePoses(const LightField& light_field, ThreadPool& pool,
                        const std::atomic<bool>& interrupted,
                        const std::function<std::string(const std::string& words)>& repair_call,
                        ImportReport* report);

// Returns the report as text: one line per fact, then the warnings.
std::string ReportText(const ImportReport& report);

// Returns the report as JSON, with all digits; unknown values are null.
std::string ReportJson(const ImportReport& report);

}  // namespace lf
