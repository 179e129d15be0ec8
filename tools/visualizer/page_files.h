// The files of the page, which the build embeds in this program (cmake/LfPage.cmake).
#pragma once

#include <span>
#include <string_view>

namespace lf {

struct PageFile {
  const char* name;  // index.html
  const char* type;  // text/html; charset=utf-8
  std::string_view bytes;
};

// Returns all files of the page; none in a build without Node.js and npm.
std::span<const PageFile> PageFiles();
// Returns nullptr if there is no such file.
const PageFile* FindPageFile(std::string_view name);

}  // namespace lf
