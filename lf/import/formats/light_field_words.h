// SPDX-License-Identifier: Apache-2.0
// The options of light fields that all programs share, as texts: what people say besides the name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"

namespace lf {

// Each member has the meaning and the default of the option of the programs with this name. 0 and
// "" mean that nothing is said.
struct LightFieldWords {
  double focal_px = 0;
  double fov_deg = 0;
  std::string images, image_scale = "auto", image_alpha = "auto", background;
  std::optional<double> time, recorded_fps;
  std::string frame_cache;
  int reduce = 1;

  // Converts the options. kUsage if a value cannot be parsed.
  Result<OpenOptions> Options() const;
  // Returns what is said as words for the command line of a program.
  std::vector<std::string> Words() const;
  // Returns these words with absolute paths, for a file that is read in other working folders, such
  // as a package (PackageSource::options).
  std::vector<std::string> WordsToKeep() const;

  // Returns what WordsToKeep() has returned. kInput: `words` are something else.
  //   path  the light field that they are said of, for the message
  static Result<LightFieldWords> Of(const std::string& path, const std::vector<std::string>& words);
};

}  // namespace lf
