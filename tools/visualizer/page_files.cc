// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_files.h"

#include <array>

#ifdef LF_PAGE_FOLDER
// Embeds a file in the section .rodata of the program. A C++ array would do the same, but compilers
// need seconds for an array of a million bytes.
#define LF_EMBED(symbol, file)                                                                     \
  asm(".section .rodata\n.global " #symbol "_begin\n" #symbol "_begin:\n.incbin \"" LF_PAGE_FOLDER \
      "/" file "\"\n.global " #symbol "_end\n" #symbol                                             \
      "_end:\n.byte 0\n"                                                                           \
      ".previous\n");                                                                              \
  extern "C" const char symbol##_begin[], symbol##_end[]
LF_EMBED(lf_page_html, "index.html");
LF_EMBED(lf_page_script, "page.js");
LF_EMBED(lf_page_style, "page.css");
#endif

namespace lf {

std::span<const PageFile> PageFiles() {
#ifdef LF_PAGE_FOLDER
  const auto between = [](const char* begin, const char* end) {
    return std::string_view(begin, static_cast<size_t>(end - begin));
  };
  static const std::array<PageFile, 3> files = {{
      {"index.html", "text/html; charset=utf-8", between(lf_page_html_begin, lf_page_html_end)},
      {"page.js", "text/javascript; charset=utf-8",
       between(lf_page_script_begin, lf_page_script_end)},
      {"page.css", "text/css; charset=utf-8", between(lf_page_style_begin, lf_page_style_end)},
  }};
  return files;
#else
  return {};
#endif
}

const PageFile* FindPageFile(std::string_view name) {
  for (const PageFile& file : PageFiles())
    if (file.name == name) return &file;
  return nullptr;
}

}  // namespace lf
