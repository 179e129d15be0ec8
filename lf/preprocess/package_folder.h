// The folder that receives the packages of a film, all of them together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/result.h"
#include "lf/core/temporary_file.h"
#include "lf/package/package_file.h"

namespace lf {

// Holds the lock DIR/.packages.lock as long as it lives. Packages are written under temporary names
// and get their own together, when all are whole: after a kill there are those of before, or none.
// Only a kill within Publish(), which takes milliseconds, may leave a part of them.
class PackageFolder {
 public:
  // Creates the folder if it is missing, and removes temporary packages of killed programs.
  //   part       only packages whose names end on it are of interest; empty: all
  //   overwrite  Publish() replaces packages that are there
  // kUsage: packages are there and are not to be replaced. kOutput: the folder, or another program
  // at work in it.
  static Result<PackageFolder> Open(const std::filesystem::path& folder, const std::string& part,
                                    bool overwrite);
  ~PackageFolder();
  PackageFolder(PackageFolder&&) noexcept = default;
  PackageFolder& operator=(PackageFolder&&) = delete;

  // Returns the final path of a package.
  std::filesystem::path PathOf(const std::string& name) const;
  // Writes a package under a temporary name. kOutput.
  Result<void> Add(const std::string& name, const Package& package, const PackageNotes& notes);
  // Removes the packages of before, and gives those that were added their names. kOutput: none of
  // them is there then.
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
