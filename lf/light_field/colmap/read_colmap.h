// SPDX-License-Identifier: Apache-2.0
// Reads sparse models of COLMAP as light fields (doc/formats/colmap.md): cameras, images and
// points3D, as .bin or .txt, from a folder such as sparse/0.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Finds the model of a folder. Searches `path`, path/sparse, path/colmap/sparse, path/dense and
// path/dense/sparse, each of them first directly, then in its numbered subfolders 0, 1, ... (those
// of `path` only if path/0 exists) and in folders `sparse` and `text` in these, then in its folder
// `text`. If several numbered subfolders hold models, logs a warning and returns the one with most
// images (the first if several have equally many). nullopt if there is no model. kInput: there are
// only models that are incomplete, with a cameras file without an images file beside it, or the
// reverse (text files in `path` itself do not count, because they may belong to another program);
// an images file whose images cannot be counted.
//   warns  false: logs no warning, because the caller already did
Result<std::optional<std::filesystem::path>> FindColmapModel(const std::filesystem::path& path,
                                                             bool warns = true);

// Reads the registered images, sorted by name. Files in .bin form are preferred to .txt. Besides
// the result, the function needs memory for a block of a file, a sample of depths, some 50 bytes
// per image and 380 per camera.
//
//   images_folder  folder of the image files; not checked
// If images_folder is not given, it is the first of these folders that contains one of the first 64
// images: `images` in the model folder and in the three folders above it, then these four folders
// themselves. If none of them does, images are searched by name below the project folder
// (light_field/model/find_images.h): the model folder after numbered folders, `sparse`, `text`,
// `dense` and `colmap` are removed from the end of its path.
//
// mask_names are MasksIn() (light_field/model/masks_beside.h) the folder masks beside the folder of
// images. depth_range is
// computed from the points: the 1st and 99th percentile of their depths along the optical axes of
// the cameras that see them.
// kInput: broken files, unsupported camera models, unknown ids, no images, or no image file found
// (the message lists the folders that were searched). The message names the file and the entry.
Result<LightField> ReadColmapModel(
    const std::filesystem::path& model_folder,
    const std::optional<std::filesystem::path>& images_folder = std::nullopt);

// The three files of a model. The file of the points may be missing.
struct ColmapStreams {
  ByteStream cameras;
  ByteStream images;
  std::optional<ByteStream> points;
  bool is_binary = false;
};

// Opens the three files. kInput: the folder contains no model, or a file cannot be opened.
Result<ColmapStreams> OpenColmapStreams(const std::filesystem::path& model_folder);

// Reads only the calibration; LightField::folder and mask_names stay empty. Errors as for
// ReadColmapModel().
Result<LightField> ParseColmapModel(ColmapStreams streams);

}  // namespace lf
