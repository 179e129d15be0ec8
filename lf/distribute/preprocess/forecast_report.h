// SPDX-License-Identifier: Apache-2.0
// The report of lfpreprocessor (doc/formats/forecast.md).
#pragma once

#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/distribute/preprocess/known_depths.h"
#include "lf/distribute/preprocess/preprocess.h"

namespace lf {

struct ForecastFacts {
  std::string light_field;  // LIGHTFIELD as the user typed it
  std::string output;       // folder of the packages; empty: nothing is written (--plan)
  std::string next;         // line that advises the next command; empty: none
  bool rebins = false;      // KeepsCells() (render/settings/interpolation.h)
  bool completes = false;   // the mode is kHybrid: lenses beyond the capture are completed
  ImageOrder order = ImageOrder::kSpread;
  uint64_t seed = 0;
  int thread_count = 1;
  double read_s = 0;  // seconds that it took to read the calibration
  DepthSource depths_from = DepthSource::kUnknown;
  std::string depths_argument = "depths";  // the caller's name of PreprocessOptions::depths
};

// Returns warnings about missing LF images, double edges, black frames, and lenses that exceed the
// capture: what to expect, why, and what would help.
std::vector<std::string> DensityWarnings(const PreprocessReport& report, const CameraPath& path,
                                         const ForecastFacts& facts);

// Returns text such as "3 of 25 LF images that packages need do not exist, or are empty; the first:
// ..."; "" if there are none.
std::string MissingText(const PreprocessReport& report);

// Returns the report as text: one line per fact, a table of packages, a table of some frames, and
// the warnings.
std::string ForecastText(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts);

// Returns JSON about all packages and all frames, of which there may be none; lengths are in world
// units.
std::string ForecastJson(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts);

}  // namespace lf
