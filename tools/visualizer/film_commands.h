// SPDX-License-Identifier: Apache-2.0
// The commands that make the film of a page, which the page shows for people to copy.
#pragma once

#include <string>
#include <vector>

#include "tools/visualizer/page_scene.h"

namespace lf {

// Commands of a POSIX shell, one a line, with the options of LIGHTFIELD and the settings of the
// film that differ from the defaults.
struct FilmCommands {
  std::string forecast;  // prints what the render will take, and writes nothing
  std::string render;    // renders the film on this machine
  std::string packages;  // makes packages, and renders them
};

// Frames are written into the watched folder; into "frames" if none is watched.
FilmCommands CommandsOf(const PageArguments& page);

}  // namespace lf
