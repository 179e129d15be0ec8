// SPDX-License-Identifier: Apache-2.0
// Reads JPEG files in a fraction of their size, in a fraction of the time.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Called after the header is read; returns by how much the picture is reduced along each side: 2, 4
// or 8; 1: it is not read at all. If it returns an error, reading ends with this error.
using WantedReduction = std::function<Result<int>(const ImageFileInfo& info)>;

// Reads a JPEG file, reduced: a pixel is about the mean of a square of stored values (not of their
// light). A last column or row is the mean of less than a square if the size is no multiple of the
// reduction. part->info describes the file in full size; part->rect counts reduced pixels. Returns
// the reduction; 1, without reading pixels, if the file is no JPEG. Errors are those of
// ReadImagePart().
Result<int> ReadReducedJpeg(const std::filesystem::path& path, const WantedReduction& wanted,
                            ImagePart* part);
// Reads a file that is in memory; messages call it `name`.
Result<int> ReadReducedJpegBytes(std::string_view bytes, const std::string& name,
                                 const WantedReduction& wanted, ImagePart* part);

}  // namespace lf
