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
  // Renders the film with virtual LF images; "" if lfrenderer --densify would refuse.
  std::string densify;
};

// Frames are written into the watched folder; into "frames" if none is watched.
//   takes_densify  TakesDensify() of the film
FilmCommands CommandsOf(const PageArguments& page, bool takes_densify);

// Returns true if lfrenderer --densify does not refuse the kind of the light field or the settings
// before it looks at LF images.
bool TakesDensify(const LightField& light_field, const FilmSettings& film, bool has_focal_surface);

}  // namespace lf
