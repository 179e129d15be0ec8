// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/preprocess/package_folder.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>
#include <utility>

#include "lf/core/hash.h"
#include "lf/core/output_files.h"
#include "lf/light_field/model/image_files.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExtension = ".lfp";
constexpr std::string_view kPrefix = "package-";

// Returns the files of a folder that have the extension of packages.
std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (auto entry = fs::directory_iterator(folder, error);
       !error && entry != fs::directory_iterator(); entry.increment(error))
    if (entry->path().extension() == kExtension) files.push_back(entry->path());
  return files;
}

void RemoveFiles(const std::vector<fs::path>& files) {
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(file, ignored);
}

}  // namespace

std::string NameOfPart(const std::vector<FrameId>& frames, size_t film_frame_count) {
  if (frames.empty() || frames.size() == film_frame_count) return "";
  std::string ranges;
  for (size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    for (end = begin + 1; end < frames.size(); ++end)
      if (frames[end].value != frames[end - 1].value + 1) break;
    ranges += fmt::format("{}{}", ranges.empty() ? "" : "+", frames[begin].value);
    if (end > begin + 1) ranges += fmt::format("-{}", frames[end - 1].value);
  }
  constexpr size_t kLongest = 40;
  if (ranges.size() > kLongest)
    ranges = fmt::format("{}-{}-{:08x}", frames.front().value, frames.back().value,
                         static_cast<uint32_t>(HashBytes(ranges)));
  return "-of-frames-" + ranges;
}

PackageFolder::PackageFolder(fs::path folder, std::string part, FileLock lock)
    : folder_(std::move(folder)), part_(std::move(part)), lock_(std::move(lock)) {}

PackageFolder::~PackageFolder() { lock_.Remove(); }

Result<PackageFolder> PackageFolder::Open(const fs::path& folder, const std::string& part,
                                          bool overwrite) {
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  LF_ASSIGN_OR_RETURN(FileLock lock, FileLock::Take(folder / ".packages.lock"));
  PackageFolder opened(folder, part, std::move(lock));
  // The lock guarantees that no process, on this host or another one, still writes the temporary
  // files.
  std::vector<fs::path> leftovers = FilesIn(folder);
  std::erase_if(leftovers, [](const fs::path& file) {
    const std::string name = file.filename().string();
    return !IsTemporaryName(name) || !name.substr(1).starts_with(kPrefix);
  });
  RemoveFiles(leftovers);
  const size_t there = opened.Packages().size();
  if (there > 0 && !overwrite)
    return UsageError(fmt::format(
        "{}: contains {} packages already: replace them with {{overwrite}}, or give another folder",
        folder.string(), there));
  return opened;
}

std::vector<fs::path> PackageFolder::Packages() const {
  std::vector<fs::path> packages = FilesIn(folder_);
  std::erase_if(packages, [this](const fs::path& file) {
    const std::string name = file.filename().string();
    return !name.starts_with(kPrefix) ||
           (!part_.empty() && name.find(part_ + ".") == std::string::npos);
  });
  return packages;
}

Result<void> PackageFolder::CheckKeeps(const LightField& light_field,
                                       const std::vector<fs::path>& inputs) const {
  std::vector<OutputFile> files;
  for (const fs::path& package : Packages()) files.emplace_back(package, "a package");
  LF_ASSIGN_OR_RETURN(const OutputFiles replaced, OutputFiles::Make(std::move(files)));
  LF_RETURN_IF_ERROR(replaced.CheckReplacesNone(inputs));
  // The folder of a packed store is its file.
  LF_RETURN_IF_ERROR(replaced.CheckReplacesNone({light_field.folder}));
  for (const auto& names : {ImageFileNames(light_field), light_field.mask_names})
    LF_RETURN_IF_ERROR(replaced.CheckReplacesNone(light_field.folder, names, "an LF image"));
  return {};
}

fs::path PackageFolder::PathOf(const std::string& name) const {
  return folder_ / (name + kExtension);
}

Result<void> PackageFolder::Add(const std::string& name, const Package& package,
                                const PackageNotes& notes) {
  const fs::path path = PathOf(name);
  renamings_.push_back({files_.emplace_back(path).path(), path});
  LF_RETURN_IF_ERROR(WritePackageAs(renamings_.back().from, path, package, notes));
  return FlushToDisk(renamings_.back().from);  // flushed here, so that Publish() is quick
}

Result<void> PackageFolder::Publish() {
  RemoveFiles(Packages());
  const Result<void> renamed = RenameFlushed(renamings_);
  if (!renamed) {
    // Removes all renamed packages, because a part of the packages could be mistaken for all of
    // them.
    for (const Renaming& file : renamings_) RemoveFiles({file.to});
    return renamed.error();
  }
  for (TemporaryFile& file : files_) file.Keep();
  return {};
}

}  // namespace lf
