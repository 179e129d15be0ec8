// SPDX-License-Identifier: Apache-2.0
// Opens light field videos: a video, or a folder of frames, of each LF camera beside a calibration
// of the cameras (doc/formats/light_field_video.md). Internal to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/import/formats/open_light_field.h"

namespace lf {

// The frames of one LF camera, in a video or as image files.
struct FilmingCamera {
  std::string name;                 // of the video without its ending, or of the folder
  std::filesystem::path video;      // empty: the frames are image files
  std::vector<std::string> frames;  // the image files, relative to the folder of the light field
};

// The cameras that film in a folder, and their calibration.
struct VideoFolder {
  std::filesystem::path folder;
  std::filesystem::path calibration;   // poses_bounds.npy or models.json
  std::vector<FilmingCamera> cameras;  // sorted by name
  // True if the calibration also fits image files that are there, so that the folder is also a
  // light field without times.
  bool holds_stills = false;
};

// Looks for cameras that film in a folder with a poses_bounds.npy or models.json: at least two
// videos; or at least two folders CAMERA or CAMERA/images of image files, which are as many as the
// calibration has cameras, or none of which holds an image for each camera. nullopt: there are
// none.
std::optional<VideoFolder> FindVideoFolder(const std::filesystem::path& folder);

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
