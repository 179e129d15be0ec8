// Reads sparse models of COLMAP as light fields (doc/formats/colmap.md): cameras, images and
// points3D, as .bin or .txt, from a folder such as sparse/0.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Finds the model in or below a folder: in the folder itself, its sparse/0, sparse, colmap/sparse/0
// or colmap/sparse. If sparse holds several models (0, 1, ...), returns the one with most images,
// or the first of equal ones, with a warning. nullopt if there is no model.
// kInput: a cameras file without an images file beside it, or the reverse (text files count only
// below `path`, where they must be COLMAP's); an images file whose images cannot be counted.
//   warns  about several models; false if the caller already warned
Result<std::optional<std::filesystem::path>> FindColmapModel(const std::filesystem::path& path,
                                                             bool warns = true);

// Reads the registered images, sorted by name. .bin is preferred to .txt. Besides the result,
// memory holds a block of a file, a sample of depths, some 50 bytes per image and 380 per camera.
//
//   images_folder  where the image files are; not checked. By default the first folder that
//   contains
//                  the first image: `images` in the model folder and in the three folders above it,
//                  then these folders themselves. If none does, images are searched by name below
//                  the folder that holds the model or its sparse/0
//                  (light_field/model/find_images.h)
//
// mask_names are the existing files masks/NAME.png beside the folder of images. depth_range comes
// from the points: the 1st and 99th percentile of their depths along the optical axes of the
// cameras that see them.
// kInput, with file and entry: broken files, unsupported camera models, unknown ids, no images, no
// folder with the first image (the message lists the folders that were tried).
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

// Reads the calibration alone, without `folder` and masks. Errors as for ReadColmapModel().
Result<LightField> ParseColmapModel(ColmapStreams streams);

}  // namespace lf
