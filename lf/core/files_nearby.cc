// SPDX-License-Identifier: Apache-2.0
#include "lf/core/files_nearby.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <system_error>
#include <vector>

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostEntries = 4096, kMostNamed = 3;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Returns the file name without its suffix and without details that often differ by accident.
std::string Key(const fs::path& file) {
  std::string stem = file.stem().string();
  std::transform(stem.begin(), stem.end(), stem.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (const size_t open = stem.rfind(" ("); open != std::string::npos && stem.ends_with(')'))
    stem.resize(open);
  if (const size_t copy = stem.rfind("copy"); copy != std::string::npos && copy + 4 == stem.size())
    stem.resize(copy);
  std::string key;
  for (size_t i = 0; i < stem.size(); ++i) {
    const char c = stem[i];
    if (c == ' ' || c == '_' || c == '-') continue;
    const bool begins_number = i == 0 || !IsDigit(stem[i - 1]);
    if (c == '0' && begins_number && i + 1 < stem.size() && IsDigit(stem[i + 1])) {
      stem[i] = ' ';  // so that the next digit begins the number
      continue;
    }
    key += c;
  }
  return key;
}

struct Listing {
  std::vector<std::string> files, folders;  // names, sorted
  bool is_whole = true;
};

Listing List(const fs::path& folder) {
  Listing listing;
  std::error_code error;
  size_t count = 0;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (++count > kMostEntries) {
      listing.is_whole = false;
      break;
    }
    std::error_code ignored;
    const std::string name = it->path().filename().string();
    if (it->is_directory(ignored))
      listing.folders.push_back(name + "/");
    else
      listing.files.push_back(name);
  }
  std::sort(listing.files.begin(), listing.files.end());
  std::sort(listing.folders.begin(), listing.folders.end());
  return listing;
}

std::string FirstOf(const std::vector<std::string>& names) {
  const size_t count = std::min(names.size(), kMostNamed);
  return fmt::format("{}{}",
                     fmt::join(names.begin(), names.begin() + static_cast<ptrdiff_t>(count), ", "),
                     names.size() > count ? ", ..." : "");
}

// Describes the first folder on the path `gone` that does not exist.
std::string FolderNearby(fs::path gone) {
  std::error_code error;
  while (gone.has_parent_path() && gone.parent_path() != gone &&
         !fs::is_directory(gone.parent_path(), error))
    gone = gone.parent_path();
  if (fs::is_symlink(fs::symlink_status(gone, error)))
    return fmt::format("; {} is a link to {}, which is not there", gone.string(),
                       fs::read_symlink(gone, error).string());
  const fs::path above = gone.has_parent_path() ? gone.parent_path() : fs::path(".");
  const Listing listing = List(above);
  return fmt::format("; there is no folder {}{}", gone.string(),
                     listing.folders.empty()
                         ? ""
                         : fmt::format(": {} holds {}", above.string(), FirstOf(listing.folders)));
}

}  // namespace

std::string FilesNearby(const fs::path& missing) {
  const fs::path folder = missing.has_parent_path() ? missing.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) return FolderNearby(folder);
  if (fs::is_symlink(fs::symlink_status(missing, error)))
    return fmt::format("; it is a link to {}, which is not there",
                       fs::read_symlink(missing, error).string());
  const Listing listing = List(folder);
  if (listing.files.empty() && listing.folders.empty()) return "; its folder is empty";
  std::vector<std::string> similar;
  for (const std::string& name : listing.files)
    if (Key(name) == Key(missing.filename())) similar.push_back(name);
  if (!similar.empty()) return fmt::format("; similar there: {}", FirstOf(similar));
  if (listing.files.empty())
    return fmt::format("; its folder holds no files, but {}", FirstOf(listing.folders));
  return fmt::format("; its folder holds {}{} files, such as {}",
                     listing.is_whole ? "" : "at least ", listing.files.size(),
                     listing.files.front());
}

}  // namespace lf
