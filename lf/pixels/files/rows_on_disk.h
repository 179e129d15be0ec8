// SPDX-License-Identifier: Apache-2.0
// Reads parts of files whose pixels lie on the disk as they are, and nothing else of them. Internal
// to this folder.
#pragma once

#include <filesystem>

#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns true if parts of the file are read without decoding the rest: Netpbm (but for plain
// files), PFM and BMP. kInput: errors of ReadImageInfo().
Result<bool> HasRowsOnDisk(const std::filesystem::path& path);

// Reads the wanted pixels as ReadImagePart() does, and only their rows of the file. Returns false,
// without reading pixels, if HasRowsOnDisk() is false.
Result<bool> ReadRowsOnDisk(const std::filesystem::path& path, const WantedPixels& wanted,
                            ImagePart* part);

}  // namespace lf
