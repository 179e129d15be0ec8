// SPDX-License-Identifier: Apache-2.0
// A folder in which all packages of a film appear at the same time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/core/temporary_file.h"
#include "lf/render/package/package_file.h"

namespace lf {

// Returns the suffix of the packages' names: "-of-frames-1-4", for example, if only some frames of
// the film are packed; empty for the whole film. Because of the suffix, packages, reports and
// states of different parts of a film can be in the same folder.
std::string NameOfPart(const std::vector<FrameId>& frames, size_t film_frame_count);

// Holds the lock DIR/.packages.lock during its lifetime. Packages are written under temporary
// names. Publish() renames all of them when they are complete. If the process is killed before
// Publish(), the folder has the previous packages, if any. Only if it is killed within Publish(),
// which takes milliseconds, may some packages be missing.
class PackageFolder {
 public:
  // Creates the folder if it is missing, and removes temporary packages that killed processes left.
  //   part       only existing packages whose names end with this text are refused or replaced;
  //              empty: all existing packages
  //   overwrite  true: Publish() replaces existing packages
  // kUsage: packages exist already, and `overwrite` is false. kOutput: the folder cannot be
  // written, or another process holds its lock.
  static Result<PackageFolder> Open(const std::filesystem::path& folder, const std::string& part,
                                    bool overwrite);
  ~PackageFolder();
  PackageFolder(PackageFolder&&) noexcept = default;
  PackageFolder& operator=(PackageFolder&&) = delete;

  // kUsage if a file that Publish() replaces or removes is a file of the light field, or one of the
  // inputs.
  Result<void> CheckKeeps(const LightField& light_field,
                          const std::vector<std::filesystem::path>& inputs) const;
  // Returns the final path of a package.
  std::filesystem::path PathOf(const std::string& name) const;
  // Writes a package under a temporary name. kOutput: the file cannot be written.
  Result<void> Add(const std::string& name, const Package& package, const PackageNotes& notes);
  // Removes the previous packages (those of `part`), and gives the added packages their final
  // names. kOutput: a file could not be renamed; neither previous nor added packages are left then.
  Result<void> Publish();

 private:
  PackageFolder(std::filesystem::path folder, std::string part, FileLock lock);
  std::vector<std::filesystem::path> Packages() const;

  std::filesystem::path folder_;
  std::string part_;
  FileLock lock_;
  std::vector<TemporaryFile> files_;
  std::vector<Renaming> renamings_;
};

}  // namespace lf
