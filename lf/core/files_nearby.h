// Files near the place of a missing one, for messages: most are named a little otherwise.
#pragma once

#include <filesystem>
#include <string>

namespace lf {

// Returns words to put behind "... no such file", which begin with "; ":
//   "; similar there: image_7.png"           base names that are equal but for the suffix, case,
//                                            zeros before numbers, blanks, and (1) or copy at the
//                                            end
//   "; its folder holds 24 files, such as image_00.png", "; its folder is empty"
//   "; there is no folder a/images: a holds masks/, photos/"
//   "; a/images is a link to /nas/images, which is not there"
// At most 4096 entries of a folder are looked at, in the order of the file system.
std::string FilesNearby(const std::filesystem::path& missing);

}  // namespace lf
