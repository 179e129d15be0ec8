// SPDX-License-Identifier: Apache-2.0
// Reads the bundle.out of Bundler, which Metashape, RealityCapture and others export, too
// (doc/formats/bundler.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/import/exports/export_cameras.h"

namespace lf {

// Reads the cameras of a bundle file, version 0.3, and the names of their images, in the same
// order, from the lines of a list. Cameras with a focal length of 0 have no pose, and are left out.
// x_cam = R x_world + t, with the axes of OpenGL; the principal point is the middle of the image,
// whose size the files do not state; distortion by k1 and k2.
//   list_file  the path of the list, for messages
// kInput names the file, the line, the value and what was expected; a list with fewer lines than
// there are cameras.
Result<ExportedCameras> ParseBundler(std::string_view text, const std::filesystem::path& file,
                                     std::string_view list, const std::filesystem::path& list_file);

// The list is the first of these that exists beside NAME.out or in the folder above: NAME.list.txt,
// NAME_list.txt, NAME.out.list.txt, list.txt, image_list.txt, images.txt. kInput if there is none.
Result<LightField> ReadBundler(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
