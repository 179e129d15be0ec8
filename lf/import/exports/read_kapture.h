// SPDX-License-Identifier: Apache-2.0
// Reads data sets of kapture, versions 1.0 and 1.1 (doc/formats/kapture.md): the files sensors.txt,
// records_camera.txt, trajectories.txt and, if there are rigs, rigs.txt in a folder sensors/.
// Images are in sensors/records_data/. Fields are separated by commas; lines that begin with # are
// comments.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/exports/export_cameras.h"

namespace lf {

// The texts of the files of a data set; empty for one that is not there.
struct KaptureTexts {
  std::string_view sensors;       // id, name, camera, MODEL, width, height, parameters of COLMAP
  std::string_view records;       // timestamp, sensor, path of the image
  std::string_view trajectories;  // timestamp, sensor or rig, qw qx qy qz tx ty tz from the world
  std::string_view rigs;          // rig, sensor or rig in it, qw qx qy qz tx ty tz from the rig
};

// Parses a data set. The pose of an image is that of its sensor at its timestamp or, if there is
// none, that of a rig with the sensor, whose place in the rig follows. Images without a pose are
// left out, and counted in a message.
// kInput names the file, the line and the value: a sensor that is missing or has no lens
// (UNKNOWN_CAMERA); an error of COLMAP's cameras; rigs in each other's rigs; a wrong number.
//   folder  the folder sensors/, for messages
Result<ExportedCameras> ParseKapture(const KaptureTexts& texts,
                                     const std::filesystem::path& folder);

// Reads the data set to which `file`, one of the files above, belongs.
Result<LightField> ReadKapture(const std::filesystem::path& file, const ExportOptions& options);

}  // namespace lf
