// SPDX-License-Identifier: Apache-2.0
// The files of the page, which the build embeds in this program (cmake/LfPage.cmake).
#pragma once

#include <span>
#include <string_view>

namespace lf {

struct PageFile {
  const char* name;  // such as index.html
  const char* type;  // MIME type, such as text/html; charset=utf-8
  std::string_view bytes;
};

// Returns all files of the page; none in a build without Node.js and npm.
std::span<const PageFile> PageFiles();
// Returns the file of this name, or nullptr if there is none.
const PageFile* FindPageFile(std::string_view name);

}  // namespace lf
