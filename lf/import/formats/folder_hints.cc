// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/folder_hints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "lf/core/shell_word.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/image_files.h"

namespace lf {
namespace fs = std::filesystem;

std::string PhotographsIn(const fs::path& path) {
  constexpr size_t kMostEntries = 4096;
  for (const fs::path& folder : {path, path / kImagesName}) {
    size_t count = 0, entry_count = 0;
    std::string first;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (++entry_count > kMostEntries) break;
      const std::string name = it->path().filename().string();
      if (!IsImageName(name)) continue;
      ++count;
      if (first.empty() || name < first) first = name;
    }
    if (count > 1)
      return fmt::format(
          "; {} holds {}{} images, such as {}, but no file with the poses of the cameras: "
          "reconstruct the poses first, for instance with COLMAP (colmap automatic_reconstructor), "
          "which writes sparse/0; or, if a regular grid of cameras recorded them in the order of "
          "their names, give its columns and rows ({{lfimport grid}})",
          folder.string(), entry_count > kMostEntries ? "at least " : "", count, first);
  }
  return "";
}

std::string LightFieldsBelow(const fs::path& folder) {
  constexpr size_t kMostNames = 5;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (names.size() < kMostNames && it->is_directory(ignored) && HoldsLightField(it->path()))
      names.push_back(it->path().filename().string());
  }
  if (names.empty()) return "";
  std::sort(names.begin(), names.end());
  return fmt::format("; but there is a light field in {}/: {}", fmt::join(names, "/, "),
                     ShellCommand({"lfimport", FileArgument(folder / names[0])}));
}

}  // namespace lf
