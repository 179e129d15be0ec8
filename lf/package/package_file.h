// The file of a package: SQLite (doc/formats/package.md).
#pragma once

#include <filesystem>
#include <string>

#include "lf/core/result.h"
#include "lf/package/package.h"

namespace lf {

// By its extension, .lfp: that programs tell it from a LIGHTFIELD.
bool IsPackageName(const std::filesystem::path& path);

struct PackageNotes {
  std::string version;      // of the program
  std::string light_field;  // LIGHTFIELD, as it was given
};

// kOutput; nothing is left behind then.
Result<void> WritePackage(const std::filesystem::path& path, const Package& package,
                          const PackageNotes& notes);

// Writes the package to the file `as`, which is to be renamed to `path` later. kOutput; a part of
// the file may be there then.
Result<void> WritePackageAs(const std::filesystem::path& as, const std::filesystem::path& path,
                            const Package& package, const PackageNotes& notes);

struct ReadPackageOptions {
  // Off where damage is made on purpose: every byte is checked otherwise.
  bool check_seal = true;
};

// The package's name is that of the file. Its light_field.folder is where the LF images were; if
// that is gone, the same place seen from the file, so that a light field and its packages may move
// together.
// kInput: it cannot be read, is damaged, or of another version.
Result<Package> ReadPackage(const std::filesystem::path& path,
                            const ReadPackageOptions& options = {});

}  // namespace lf
