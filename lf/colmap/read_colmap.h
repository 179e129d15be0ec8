// Sparse models of COLMAP as light fields (doc/formats/colmap.md): cameras, images and points3D, as
// .bin or .txt, from a folder such as sparse/0.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// The model in or below a folder: the folder itself, its sparse/0, sparse, colmap/sparse/0 or
// colmap/sparse. Where sparse holds several models (0, 1, ...), the one with most images, with a
// warning; of equals the first. None if there is none.
// kInput: a cameras file without an images file beside it or the other way round (as text only
// below `path`, where it is COLMAP's for sure); an images file whose images cannot be counted.
//   warns  of several models: false if it has been warned of them
Result<std::optional<std::filesystem::path>> FindColmapModel(const std::filesystem::path& path,
                                                             bool warns = true);

// The registered images, sorted by name. .bin goes before .txt. Besides the result, a block
// of a file and a sample of depths, some 50 bytes for each image and 380 for each camera are in
// memory while it reads.
//
//   images_folder  where the image files are, not checked; if not given, searched: `images` in the
//                  model folder and in the three above it, then these themselves; the first in
//                  which the first image exists; else by their names below the folder that
//                  holds the model or its sparse/0 (capture/find_images.h)
//
// mask_names come from masks/NAME.png beside the folder of images, where such files exist;
// depth_range from the points (the 1st and 99th percentile of the depths along the optical axes of
// the cameras that see them).
// kInput, with file and entry: broken files, camera models that are not supported, unknown ids, no
// images, no folder that holds the first image (the message lists those that were tried).
Result<LightField> ReadColmapModel(
    const std::filesystem::path& model_folder,
    const std::optional<std::filesystem::path>& images_folder = std::nullopt);

// The three files of a model; points may be missing.
struct ColmapStreams {
  ByteStream cameras;
  ByteStream images;
  std::optional<ByteStream> points;
  bool is_binary = false;
};

// Opens the three files. kInput: there is no model in the folder.
Result<ColmapStreams> OpenColmapStreams(const std::filesystem::path& model_folder);

// The calibration alone, without `folder` and masks. Errors as above.
Result<LightField> ParseColmapModel(ColmapStreams streams);

}  // namespace lf
