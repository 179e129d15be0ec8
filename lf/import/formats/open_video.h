// SPDX-License-Identifier: Apache-2.0
// Opens light field videos: a video, or a folder of frames, of each LF camera beside a calibration
// of the cameras (doc/formats/light_field_video.md). Internal to this folder.
#pragma once

#include <filesystem>

#include "lf/core/result.h"
#include "lf/import/formats/find_video_folder.h"
#include "lf/import/formats/open_light_field.h"

namespace lf {

// Opens the slices of OpenOptions::time or of OpenOptions::path_times.
//   asked_for  the light field as the user typed it
// kUsage: none of both is given (the message says which times there are, and repeats the call with
// one of them); a time outside of the video. kInput: the numbers of cameras and videos differ; no
// video can be read; an error of the calibration. kOutput: ffmpeg cannot be run, or decoded frames
// cannot be written. A video that cannot be read, or that is too short, is warned of, and its LF
// image has no file.
Result<LightField> OpenVideoFolder(const VideoFolder& found, const OpenOptions& options,
                                   const std::filesystem::path& asked_for);

// Opens the slices of a light field whose calibration states a time for each LF image
// (LightField::times), if several LF images have the same of several times. Otherwise the light
// field stays as it is, and a warning says so if the times differ.
//   path  for messages
// Errors as for OpenVideoFolder(); kUsage if a time is given for another light field.
Result<void> ChooseTimes(const OpenOptions& options, const std::filesystem::path& path,
                         LightField* light_field);

}  // namespace lf
