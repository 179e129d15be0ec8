// The folder that receives all packages of a film at once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/core/temporary_file.h"
#include "lf/render/package/package_file.h"

namespace lf {

// Holds the lock DIR/.packages.lock during its lifetime. Packages are written under temporary
// names, and renamed together when all are complete. After a kill, the folder has the previous
// packages, or none. Only a kill within Publish(), which takes milliseconds, may leave a part of
// them.
class PackageFolder {
 public:
  // Creates the folder if it is missing, and removes temporary packages of killed programs.
  //   part       only packages whose names end with it are considered; empty: all
  //   overwrite  Publish() replaces existing packages
  // kUsage: packages exist and may not be replaced. kOutput: the folder cannot be written, or
  // another program is at work in it.
  static Result<PackageFolder> Open(const std::filesystem::path& folder, const std::string& part,
                                    bool overwrite);
  ~PackageFolder();
  PackageFolder(PackageFolder&&) noexcept = default;
  PackageFolder& operator=(PackageFolder&&) = delete;

  // Returns the final path of a package.
  std::filesystem::path PathOf(const std::string& name) const;
  // Writes a package under a temporary name. kOutput: it cannot be written.
  Result<void> Add(const std::string& name, const Package& package, const PackageNotes& notes);
  // Removes the previous packages, and renames the added ones to their final names. kOutput:
  // renaming failed; no package is left then.
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
