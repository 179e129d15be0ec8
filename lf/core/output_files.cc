// SPDX-License-Identifier: Apache-2.0
#include "lf/core/output_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "lf/core/file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

std::string_view NameIn(const std::string& path) {
  return std::string_view(path).substr(path.rfind('/') + 1);
}

std::optional<std::pair<dev_t, ino_t>> NumberOf(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return std::pair(status.st_dev, status.st_ino);
}

// Returns the canonical path of a folder that may be missing, in whole or in part.
fs::path CanonicalFolder(const fs::path& folder) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error || !canonical.is_absolute()) canonical = fs::absolute(canonical, error);
  return canonical.lexically_normal();
}

// Finds canonical paths, and asks the disk about each folder only once.
class CanonicalPaths {
 public:
  const fs::path& OfFolder(const fs::path& folder) {
    const auto [known, is_new] = folders_.try_emplace(folder);
    if (is_new) known->second = CanonicalFolder(folder);
    return known->second;
  }
  // Follows the path if it is a link.
  fs::path OfFile(const fs::path& path) {
    std::error_code error;
    if (fs::is_symlink(path, error)) return CanonicalFolder(path);
    return OfFolder(path.parent_path()) / path.filename();
  }

 private:
  std::map<fs::path, fs::path> folders_;
};

Error SameTwice(const OutputFile& a, const OutputFile& b) {
  return UsageError(fmt::format("{}: would be written as {} and as {}: give another {}",
                                b.path.string(), a.what, b.what, b.option));
}

Error Replaces(const OutputFile& output, std::string_view what, const fs::path& input) {
  return UsageError(fmt::format("{}: would be replaced, but is {} ({}): give another {}",
                                output.path.string(), what, input.string(), output.option));
}

}  // namespace

Result<OutputFiles> OutputFiles::Make(std::vector<OutputFile> files) {
  OutputFiles outputs;
  outputs.files_ = std::move(files);
  CanonicalPaths canonical;
  for (size_t i = 0; i < outputs.files_.size(); ++i) {
    const OutputFile& file = outputs.files_[i];
    const std::string path = canonical.OfFile(file.path).string();
    const auto [other, is_new] = outputs.paths_.emplace(path, i);
    if (!is_new) return SameTwice(outputs.files_[other->second], file);
    outputs.names_.emplace(NameIn(path));
    if (const auto number = NumberOf(file.path)) outputs.numbers_.emplace(*number, i);
  }
  return outputs;
}

const OutputFile* OutputFiles::FindByNumber(const fs::path& input) const {
  const auto number = NumberOf(input);
  if (!number) return nullptr;
  const auto found = numbers_.find(*number);
  return found == numbers_.end() ? nullptr : &files_[found->second];
}

Result<void> OutputFiles::CheckReplacesNone(const std::vector<fs::path>& inputs,
                                            std::string_view what) const {
  if (!AnyExists()) return {};
  for (const fs::path& input : inputs)
    if (const OutputFile* const output = FindByNumber(input)) return Replaces(*output, what, input);
  return {};
}

Result<void> OutputFiles::CheckReplacesNone(const fs::path& folder,
                                            const std::vector<std::string>& names,
                                            std::string_view what) const {
  constexpr size_t kMostLooks = 20'000;
  if (!AnyExists()) return {};
  CanonicalPaths canonical;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    const fs::path input = folder / name;
    const OutputFile* output = nullptr;
    if (names_.contains(NameIn(name))) {
      const auto found =
          paths_.find((canonical.OfFolder(input.parent_path()) / NameIn(name)).string());
      if (found != paths_.end()) output = &files_[found->second];
    }
    if (output == nullptr && names.size() <= kMostLooks) output = FindByNumber(input);
    if (output != nullptr) return Replaces(*output, what, input);
  }
  return {};
}

Result<void> CheckOutputFiles(std::vector<OutputFile> outputs,
                              const std::vector<fs::path>& inputs) {
  LF_ASSIGN_OR_RETURN(const OutputFiles files, OutputFiles::Make(std::move(outputs)));
  return files.CheckReplacesNone(inputs);
}

bool LiesIn(const fs::path& path, const fs::path& folder) {
  const fs::path inner = CanonicalFolder(path), outer = CanonicalFolder(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

Result<FileLock> LockOutputFolder(const fs::path& folder) {
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  LF_ASSIGN_OR_RETURN(FileLock lock, FileLock::Take(folder / ".outputs.lock"));
  lock.RemoveInTheEnd();
  return lock;
}

Result<FileLock> LockOutput(const fs::path& output) {
  const fs::path name = "." + output.filename().string() + ".lock";
  LF_ASSIGN_OR_RETURN(FileLock lock, FileLock::Take(output.parent_path() / name));
  lock.RemoveInTheEnd();
  return lock;
}

Result<std::vector<FileLock>> LockOutputs(const std::vector<fs::path>& outputs) {
  std::vector<FileLock> locks;
  if (outputs.size() < 2) return locks;
  for (const fs::path& output : outputs) {
    LF_ASSIGN_OR_RETURN(FileLock lock, LockOutput(output));
    locks.push_back(std::move(lock));
  }
  return locks;
}

}  // namespace lf
