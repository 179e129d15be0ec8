// SPDX-License-Identifier: Apache-2.0
// Kinds of files that options take, for completion in shells and for man pages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lf {

// Files that an option takes.
struct TakenFiles {
  // light_field, path, package, store, plate, image, folder, file (any), or extensions: ".exr"
  std::vector<std::string> kinds;
  std::vector<std::string> extensions;  // of all kinds, such as ".lfp"; empty: of any name
  bool folders = false;                 // true if a folder may be the value
};

// Declares which files an option takes, in place of those that its placeholder says. Accepts every
// word: the program says what is wrong with a file.
//   kinds  as in TakenFiles, separated by spaces: "light_field path package", ".png .exr folder"
CLI::Validator TakesFiles(const std::string& kinds);

// Returns the files that an option takes; no kinds if it takes none. An option without
// TakesFiles() takes those that its placeholder, or the name of the positional argument, says:
// LIGHTFIELD, PATH, PACKAGE, STORE.lfs, DIR, FOLDER and FILE.
TakenFiles FilesOf(const CLI::Option& option);

}  // namespace lf
