// SPDX-License-Identifier: Apache-2.0
#include "tools/common/next_step.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "lf/core/shell_word.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool Has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// True for "--pitch" and "-o", but not for the value "-1".
bool IsOption(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && (word[1] < '0' || word[1] > '9') && word[1] != '.';
}

// Removes each use of an option, "--pitch 1" or "--pitch=1", with its values.
void RemoveOption(const std::string& option, size_t value_count, std::vector<std::string>* words) {
  for (size_t i = 0; i < words->size();) {
    size_t count = 0;
    if ((*words)[i] == option) count = 1 + value_count;
    if ((*words)[i].starts_with(option + "=")) count = value_count;
    const auto begin = words->begin() + static_cast<std::ptrdiff_t>(i);
    words->erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(count, words->size() - i)));
    if (count == 0) ++i;
  }
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

// The command line of this process.
std::vector<std::string>& CallWords() {
  static std::vector<std::string> words;
  return words;
}

}  // namespace

std::string SameCall(std::span<const std::string> call, const std::vector<std::string>& added,
                     const std::vector<std::string>& dropped) {
  const auto rest = std::find(call.begin(), call.end(), "--");
  std::vector<std::string> words;
  for (auto word = call.begin(); word != rest; ++word)
    if (!Has(dropped, *word)) words.push_back(*word);
  for (auto option = added.begin(); option != added.end();) {
    const auto next =
        std::find_if(std::next(option), added.end(), [](const auto& w) { return IsOption(w); });
    const auto value_count = static_cast<size_t>(std::distance(option, next)) - 1;
    if (value_count > 0) RemoveOption(*option, value_count, &words);
    if (value_count > 0 || !Has(words, *option)) words.insert(words.end(), option, next);
    option = next;
  }
  words.insert(words.end(), rest, call.end());
  return ShellCommand(words);
}

void SetCallOfProgram(std::vector<std::string> words) { CallWords() = std::move(words); }

CallAgain CallOfProgram() {
  return [](const std::vector<std::string>& added) { return SameCall(CallWords(), added); };
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
