// SPDX-License-Identifier: Apache-2.0
#include "tools/common/next_step.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "lf/core/shell_word.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool Has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Returns the files in a folder whose names match a pattern of the shell.
std::set<fs::path> Matching(const fs::path& folder, const std::string& pattern) {
  std::set<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const fs::path name = entry.path().filename();
    if (::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0) files.insert(folder / name);
  }
  return files;
}

}  // namespace

std::string SameCall(std::span<const std::string> call, const std::vector<std::string>& added,
                     const std::vector<std::string>& dropped) {
  const auto rest = std::find(call.begin(), call.end(), "--");
  std::vector<std::string> words;
  for (auto word = call.begin(); word != rest; ++word)
    if (!Has(dropped, *word)) words.push_back(*word);
  for (const std::string& word : added)
    if (!word.starts_with("--") || !Has(words, word)) words.push_back(word);
  words.insert(words.end(), rest, call.end());
  return ShellCommand(words);
}

std::string ShellPackages(const std::vector<std::string>& packages) {
  std::vector<std::string> words;
  for (const std::string& package : packages) words.push_back(FileArgument(package));
  if (packages.size() == 1) return ShellCommand(words);
  const fs::path folder = fs::path(packages.front()).parent_path();
  // The names that lfpreprocessor gives: package-0000.lfp, package-0000-of-frames-1-4.lfp.
  const std::string first = fs::path(packages.front()).filename().string();
  constexpr size_t kNumbered = std::string_view("package-0000").size();
  const std::string rest = first.size() > kNumbered ? first.substr(kNumbered) : ".lfp";
  for (const std::string& pattern : {"package-*" + rest, "package-????" + rest})
    if (Matching(folder, pattern) == std::set<fs::path>(packages.begin(), packages.end()))
      return ShellWord(folder.empty() ? "." : FileArgument(folder)) + "/" + pattern;
  return ShellCommand(words);
}

std::string FreeName(const std::string& stem, const std::string& extension) {
  fs::path name = stem + extension;
  std::error_code ignored;
  for (int n = 2; fs::exists(name, ignored) && !fs::is_empty(name, ignored); ++n)
    name = fmt::format("{}-{}{}", stem, n, extension);
  return name.string();
}

std::string NextRender(const std::string& input, const std::vector<std::string>& options) {
  std::vector<std::string> words = {"-o", FreeName("frames", "")};
  words.insert(words.end(), options.begin(), options.end());
  return fmt::format("next: lfrenderer {} {}\n", input, ShellCommand(words));
}

}  // namespace lf
