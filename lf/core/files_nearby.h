// SPDX-License-Identifier: Apache-2.0
// Describes for error messages what exists near a missing file, because most files that are not
// found exist under a slightly different name.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns text to append to "... no such file". It begins with "; ", for example:
//   "; similar there: image_7.png"           names that are equal but for suffix, case, zeros
//                                            before numbers, blanks, _, -, and (1) or copy
//                                            at the end
//   "; its folder holds 24 files, such as image_00.png", "; its folder is empty"
//   "; there is no folder a/images: a holds masks/, photos/"
//   "; a/images is a link to /nas/images, which is not there"
// At most 4096 entries of a folder are looked at, in the order of the file system.
std::string FilesNearby(const std::filesystem::path& missing);

}  // namespace lf
