// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "lf/import/exports/import_limits.h"

namespace lf {
namespace fs = std::filesystem;

Result<std::vector<fs::path>> SortedFilesIn(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, error);
  for (const fs::directory_iterator end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.ends_with(ending) && !name.starts_with('.')) files.push_back(folder / name);
  }
  if (error)
    return InputError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  if (files.size() > kMaxImageCount)
    return InputError(fmt::format("{}: holds {} files *{}: expected at most {}", folder.string(),
                                  files.size(), ending, kMaxImageCount));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace lf
