// What lfimport tells: doc/formats/import_report.md.
#pragma once

#include <optional>
#include <string>

#include "lf/exposure/match_exposure.h"
#include "lf/import/capture_report.h"
#include "lf/import/check_images.h"
#include "lf/import/exif_gains.h"

namespace lf {

struct ImportReport {
  std::string light_field;  // as the user called it
  std::string first_image;  // its file: tells where the images were found
  CaptureReport capture;
  std::optional<ImageFaults> faults;  // none: not checked
  size_t excluded_count = 0;
  std::optional<ExifGains> exif_gains;      // none: not asked for
  std::optional<MatchedExposure> exposure;  // none: not asked for
  std::string written;                      // the transforms.json; "": none
};

// Adds the warnings missing-images and broken-images.
void WarnOfFaults(const LightField& light_field, ImportReport* report);

// A line per fact, then the warnings.
std::string ReportText(const ImportReport& report);

// All digits; what is not known is null.
std::string ReportJson(const ImportReport& report);

}  // namespace lf
