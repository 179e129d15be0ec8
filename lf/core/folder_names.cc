// SPDX-License-Identifier: Apache-2.0
#include "lf/core/folder_names.h"

#include <string_view>
#include <system_error>

namespace lf {
namespace fs = std::filesystem;

FolderNames::Names FolderNames::NamesIn(const fs::path& folder) {
  Names found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    found.names.insert(it->path().filename().string());
  found.is_listed = !error || error == std::errc::no_such_file_or_directory ||
                    error == std::errc::not_a_directory;
  return found;
}

// The text is divided at the last slash, because fs::path divides it at each, which takes longer.
bool FolderNames::Has(const fs::path& file) {
  const std::string& text = file.native();
  const size_t slash = text.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : text.substr(0, slash + 1);
  auto found = folders_.find(folder);
  if (found == folders_.end()) found = folders_.emplace(folder, NamesIn(folder)).first;
  const Names& names = found->second;
  return !names.is_listed || names.names.contains(text.substr(slash + 1));
}

}  // namespace lf
