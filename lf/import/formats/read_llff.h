// SPDX-License-Identifier: Apache-2.0
// Reads poses_bounds.npy of LLFF and of the NeRF data sets that follow it (doc/formats/llff.md): an
// array of (N, 17) numbers beside a folder of N images. The rows belong to the image files sorted
// by name:
//
//   15 numbers: a 3x5 matrix, row by row, with the columns: camera axes down, right and backwards |
//               camera centre | (height, width, focal length in pixels)
//    2 numbers: near and far bound of the depths
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

inline constexpr const char* kLlffName = "poses_bounds.npy";

// Parses the content of a file.
//   bytes          the file's content
//   path           the file's path for messages; its folder becomes LightField::folder
//   image_names    names of the image files in images_folder, sorted
//   images_folder  folder of the image files, relative to that of `path`
//   image_size     returns the size of an image; called for the first image only
// The principal point is the image centre; depth_range extends from the smallest near bound to the
// largest far bound.
// kInput: another type or shape; different numbers of rows and images; a first image that has
// neither the size that the rows state nor a whole fraction of it (IsWholeFraction()), as the
// smaller copies have that LLFF makes in images_4 or images_8; an axis that is mirrored or sheared.
// The message names the file and the row, the value found and what was expected.
Result<LightField> ParseLlff(std::string_view bytes, const std::filesystem::path& path,
                             std::span<const std::string> image_names,
                             const ImageSizeSource& image_size,
                             const std::filesystem::path& images_folder = "images");

// Reads a file as ParseLlff() does. The images are those of the first of these folders that holds
// as many image files as the file has rows: `images_folder`, if it is given; and in it or, if it is
// not given, beside the file: images; images_2, images_4 ... with smaller copies; any other folder,
// but for those that are named after something else than photographs, such as masks; the folder
// itself.
Result<LightField> ReadLlff(const std::filesystem::path& path,
                            const std::optional<std::filesystem::path>& images_folder = {});

}  // namespace lf
