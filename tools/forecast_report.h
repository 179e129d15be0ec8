// What lfpreprocessor tells: doc/formats/forecast.md.
#pragma once

#include <string>
#include <vector>

#include "tools/common/allow_missing.h"

#include "lf/path/camera_path.h"
#include "lf/preprocess/preprocess.h"

namespace lf {

struct ForecastFacts {
  std::string light_field;     // as the user called it
  std::string output;          // folder of the packages; empty: a plan
  std::string render_options;  // that lfrenderer wants for them
  bool rebins = false;         // RenderMode::kRebin or kHybrid
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  int thread_count = 1;
  double read_s = 0;  // spent on the calibration
  // What tells the depths of the scene: "--depths", "the calibration", "LF images"; empty: nothing.
  std::string depths_from;
};

// What a capture is too sparse for, in plain words: what to expect, why, and what would work.
std::vector<std::string> DensityWarnings(const PreprocessReport& report, const CameraPath& path,
                                         const ForecastFacts& facts);

// The files that packages need and that are not there.
MissingImages MissingOf(const PreprocessReport& report);

// A line per fact, a table of packages, one of some frames, then the warnings.
std::string ForecastText(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts);

// All packages and all frames; lengths are world units.
std::string ForecastJson(const PreprocessReport& report, const CameraPath& path,
                         const ForecastFacts& facts);

}  // namespace lf
