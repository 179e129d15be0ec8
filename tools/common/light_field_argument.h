// SPDX-License-Identifier: Apache-2.0
// The argument LIGHTFIELD and its options, which all programs share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lf/import/formats/open_light_field.h"

namespace lf {

// The values as the user gave them. 0 and "" mean that an option was not given.
struct LightFieldArgument {
  std::string path;  // LIGHTFIELD or, if a program has this option, --lightfield
  double focal_px = 0;
  double fov_deg = 0;
  std::string images, image_scale = "auto", image_alpha = "auto", background;

  // Adds the positional argument and its options.
  void AddTo(CLI::App& app);
  // Adds only the options, without the positional argument.
  void AddOptionsTo(CLI::App& app);
  // Converts the options. kUsage if a value cannot be parsed.
  Result<OpenOptions> Options() const;
  Result<LightField> Open() const;
  // kUsage if an option is given that packages would ignore, because they contain their calibration
  // and the meaning of alpha. With --lightfield (`path`), only --image-alpha and --background are
  // refused; the other options apply to the light field that it names.
  Result<void> CheckWithPackages() const;
  // Returns the given options, without `path`, as words for the command line of another program.
  std::vector<std::string> Words() const;
  // Returns these words with absolute paths, for a file that is read in other working folders.
  std::vector<std::string> WordsToKeep() const;

  // Returns the argument with the options that WordsToKeep() has returned. kInput: `words` holds
  // something else.
  static Result<LightFieldArgument> Of(std::string path, const std::vector<std::string>& words);
};

}  // namespace lf
