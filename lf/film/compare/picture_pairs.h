// SPDX-License-Identifier: Apache-2.0
// Finds which pictures are to be compared.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct PicturePair {
  std::string name;  // of both pictures, without the extension; "frame_0012"
  std::filesystem::path reference;
  std::filesystem::path test;
};

// Returns the pair of two files, or the pairs of pictures with equal names in two folders, in the
// order of their names. The extensions (.png, .jpg, .jpeg, .tif, .tiff, .exr) may differ. Contact
// sheets and other files are left out.
//   common  true: pictures that only one folder has are left out
// kInput: a path does not exist; one is a file and the other a folder; a folder cannot be read, or
// has two pictures with one name; no name is in both folders, or, unless `common` is true, a name
// is in only one of them.
Result<std::vector<PicturePair>> FindPicturePairs(const std::filesystem::path& reference,
                                                  const std::filesystem::path& test, bool common);

}  // namespace lf
