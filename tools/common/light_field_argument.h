// SPDX-License-Identifier: Apache-2.0
// The argument LIGHTFIELD and its options, which all programs share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "lf/core/result.h"
#include "lf/import/formats/light_field_words.h"
#include "lf/import/formats/open_light_field.h"

namespace lf {

// The values as the user gave them.
struct LightFieldArgument : LightFieldWords {
  std::string path;  // LIGHTFIELD or, if a program has this option, --lightfield

  // Adds the positional argument and its options.
  void AddTo(CLI::App& app);
  // Adds only the options, without the positional argument.
  void AddOptionsTo(CLI::App& app);
  // Adds the option that loads smaller LF images, for programs that need no whole ones.
  void AddReduceTo(CLI::App& app);
  Result<LightField> Open() const;
  // Opens the light field for the frames of a path. Of a light field video, without --time, these
  // are the slices that the frames show (RecordingTimesOf() of import/paths/recording_times.h).
  Result<LightField> OpenFor(const std::string& path_file) const;
  // kUsage if an option is given that packages would ignore, because they contain their calibration
  // and the meaning of alpha. With --lightfield (`path`), only --image-alpha and --background are
  // refused; the other options apply to the light field that it names.
  Result<void> CheckWithPackages() const;
};

}  // namespace lf
