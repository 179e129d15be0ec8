// SPDX-License-Identifier: Apache-2.0
// Answers which of many files exist by listing each of their folders once. Asking the system for
// each of a million files takes seconds, and on a file server minutes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_set>

namespace lf {

class FolderNames {
 public:
  // Returns true if the folder of the file lists its name, or may not be listed. Each folder is
  // listed at the first question about a file in it.
  bool Has(const std::filesystem::path& file);
  // Returns how many folders were listed so far.
  size_t listed_count() const { return folders_.size(); }

 private:
  struct Names {
    bool is_listed = true;
    std::unordered_set<std::string> names;
  };
  static Names NamesIn(const std::filesystem::path& folder);

  std::map<std::string, Names> folders_;
};

}  // namespace lf
