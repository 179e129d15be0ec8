// SPDX-License-Identifier: Apache-2.0
// Reads Middlebury's multi-view calibrations, NAME_par.txt (doc/formats/middlebury.md): the number
// of images, then a line for each image:
//   imgname.png k11 k12 k13 k21 k22 k23 k31 k32 k33 r11 r12 r13 r21 r22 r23 r31 r32 r33 t1 t2 t3
//
// P = K [R t] projects a point of the world to a pixel; the camera axes are x right, y down, z
// forward. In the file, the centre of the upper left pixel is (0, 0); 0.5 is added to k13 and k23
// on reading.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Parses the content of a file.
//   text        the file's content
//   path        the file's path for messages; its folder becomes LightField::folder
//   image_size  called for the first image; all images get the size that it returns
// kInput names the file, the line and the image, the value found and what was expected.
Result<LightField> ParseMiddlebury(std::string_view text, const std::filesystem::path& path,
                                   const ImageSizeSource& image_size);

// Reads a file as ParseMiddlebury() does. The size of the images is read from the header of the
// first image, which is searched by FindImageFiles() (light_field/model/find_images.h) with the
// given folder of images. kInput if the file is larger than 256 MiB.
Result<LightField> ReadMiddlebury(
    const std::filesystem::path& path,
    const std::optional<std::filesystem::path>& images_folder = std::nullopt);

bool IsMiddleburyName(std::string_view file_name);  // true if the name ends in _par.txt

// Returns the files in a folder for which IsMiddleburyName() is true, sorted.
std::vector<std::filesystem::path> MiddleburyFiles(const std::filesystem::path& folder);

}  // namespace lf
