// SPDX-License-Identifier: Apache-2.0
#include "tools/common/file_kinds.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "tools/common/option_facts.h"

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr std::string_view kTakes = "takes ";

struct FileKind {
  std::string_view name;
  std::string_view extensions;  // separated by spaces
  bool folders;
};
constexpr std::array kFileKinds = {
    FileKind{
        "light_field",
        ".lfs .json .txt .npy .h5 .hdf5 .cfg .sfm .out .nvm .xml .csv .xmp "
        // Pictures of many views.
        ".png .jpg .jpeg .tif .tiff .exr .webp .jxl .heic .heif .avif .jp2 .j2k .bmp .ppm .pgm "
        ".pbm .pnm .pam .hdr",
        true},
    FileKind{"path", ".yaml .yml .json .chan", true},
    FileKind{"package", ".lfp", false},
    FileKind{"store", ".lfs", false},
    FileKind{"plate", ".plate", true},
    FileKind{"image", ".png .exr .jpg .jpeg .tif .tiff", false},
    FileKind{"folder", "", true},
    FileKind{"file", "", false},
};

struct Placeholder {
  std::string_view word, kind;
};
constexpr std::array kPlaceholders = {
    Placeholder{"LIGHTFIELD", "light_field"},
    Placeholder{"PATH", "path"},
    Placeholder{"PATH.yaml", "path"},
    Placeholder{"PACKAGE", "package"},
    Placeholder{"PACKAGES", "package"},
    Placeholder{"STORE.lfs", "store"},
    Placeholder{"DIR", "folder"},
    Placeholder{"FOLDER", "folder"},
    Placeholder{"FILE", "file"},
};

std::vector<std::string> WordsOf(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

const FileKind* KindNamed(std::string_view name) {
  for (const FileKind& kind : kFileKinds)
    if (kind.name == name) return &kind;
  return nullptr;
}

// Returns the kinds that TakesFiles() declared, or those of the placeholder.
std::vector<std::string> KindsOf(const CLI::Option& option) {
  for (const std::string& part : CLI::detail::split(option.get_type_name(), ':'))
    if (part.starts_with(kTakes)) return WordsOf(part.substr(kTakes.size()));
  std::vector<std::string> kinds;
  const std::string shown = option.get_positional() ? option.get_name(true) : PlaceholderOf(option);
  // "FILE|MATRIX" has two words, and "DIR FRAMES" stands for two values, the first a file.
  for (const std::string& word : CLI::detail::split(shown.substr(0, shown.find(' ')), '|'))
    for (const Placeholder& placeholder : kPlaceholders)
      if (placeholder.word == word) kinds.emplace_back(placeholder.kind);
  return kinds;
}

}  // namespace

CLI::Validator TakesFiles(const std::string& kinds) {
  for (const std::string& kind : WordsOf(kinds))
    LF_CHECK(kind.starts_with('.') || KindNamed(kind) != nullptr);
  return CLI::Validator([](const std::string&) -> std::string { return ""; },
                        std::string(kTakes) + kinds);
}

TakenFiles FilesOf(const CLI::Option& option) {
  TakenFiles taken;
  taken.kinds = KindsOf(option);
  bool any = false;
  for (const std::string& name : taken.kinds) {
    const FileKind* const kind = KindNamed(name);
    for (const std::string& extension : WordsOf(kind ? kind->extensions : name))
      if (std::find(taken.extensions.begin(), taken.extensions.end(), extension) ==
          taken.extensions.end())
        taken.extensions.push_back(extension);
    taken.folders |= kind && kind->folders;
    any |= name == "file";
  }
  if (any) taken.extensions.clear();
  return taken;
}

}  // namespace lf
