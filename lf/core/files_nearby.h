// Describes what is near a missing file, for messages, since most missing files have a slightly
// different name.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns text to append to "... no such file". It begins with "; ":
//   "; similar there: image_7.png"           base names that are equal but for the suffix, case,
//                                            zeros before numbers, blanks, _, -, and (1) or copy
//                                            at the end
//   "; its folder holds 24 files, such as image_00.png", "; its folder is empty"
//   "; there is no folder a/images: a holds masks/, photos/"
//   "; a/images is a link to /nas/images, which is not there"
// At most 4096 entries of a folder are looked at, in the order of the file system.
std::string FilesNearby(const std::filesystem::path& missing);

}  // namespace lf
