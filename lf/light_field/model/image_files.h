// SPDX-License-Identifier: Apache-2.0
// Names and sizes of image files, for calibrations that do not state an image size.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// A function that returns the [width, height] of an image file in pixels.
using ImageSizeSource = std::function<Result<std::array<int, 2>>(const std::filesystem::path&)>;

// Returns the path of the file that holds an LF image: LightField::ImagePath(), but for a view that
// of its picture (pixels/files/picture_view.h).
std::filesystem::path ImageFileOf(const LightField& light_field, LfImageId id);

// Returns the names of the files that hold LF images, as LightField::image_names but without views.
std::vector<std::string> ImageFileNames(const LightField& light_field);

// Returns the bytes of the picture that is kept while its views are read; 0 if the LF images are no
// such views. Reads the header of the first LF image's picture.
size_t SharedPictureBytes(const LightField& light_field);

// Reads the [width, height] in pixels from the header of the file (ReadImageInfo() of
// pixels/files).
Result<std::array<int, 2>> ImageSizeInHeader(const std::filesystem::path& image);

// Returns true for the extensions of the formats that ReadImage() reads (in upper or lower case),
// and for raw files, as IsRawName() says. PFM files are not looked for, because they are mostly
// depths that lie beside the images.
bool IsImageName(std::string_view file_name);

// Returns the names of the image files in a folder, sorted by bytes, without hidden files. kInput
// if the folder cannot be listed.
Result<std::vector<std::string>> SortedImageNames(const std::filesystem::path& folder);

}  // namespace lf
