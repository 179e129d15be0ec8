// SPDX-License-Identifier: Apache-2.0
// Finds the cameras of a light field video in a folder (doc/formats/light_field_video.md). Internal
// to this folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/import/exports/export_cameras.h"
#include "lf/import/exports/import_limits.h"

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

// Returns the number of rows of a poses_bounds.npy of at most kMostPoseBytes; 0 if it is none.
inline constexpr size_t kMostPoseBytes = kMaxImageCount * 17 * sizeof(double) + (size_t{1} << 17);
size_t PoseRowCount(const std::filesystem::path& file);

// Returns the name by which the video or folder of a camera of a models.json is found.
std::string NameOfModel(const ExportedImage& model);

}  // namespace lf
