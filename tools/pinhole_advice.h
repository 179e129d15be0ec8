// SPDX-License-Identifier: Apache-2.0
// Warns of films of a pinhole that nobody may have meant, such as paths from Blender, whose cameras
// have no depth of field by default.
#pragma once

#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Warns once if the aperture is 0 in all frames of the path: proposes a lens of the capture, and
// the command that makes a path with it. Says nothing if the settings tell how a pinhole is filled,
// because it is then meant: lens weights, rebinned rays, or rules that count rays. Says nothing of
// densified light fields either, whose virtual LF images are at the pinhole.
//   light_field_name, path_name  the arguments LIGHTFIELD and PATH of this call
void WarnOfPinhole(const LightField& light_field, const CameraPath& path, const FilmSettings& film,
                   const std::string& light_field_name, const std::string& path_name);

}  // namespace lf
