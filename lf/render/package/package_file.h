// SPDX-License-Identifier: Apache-2.0
// Reads and writes the SQLite file of a package (doc/formats/package.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lf/core/result.h"
#include "lf/render/package/package.h"

namespace lf {

// Returns true if the path has the extension .lfp, by which programs tell a package from a
// LIGHTFIELD.
bool IsPackageName(const std::filesystem::path& path);

struct PackageNotes {
  std::string version;                                // version of the program
  std::string light_field;                            // LIGHTFIELD, as the user gave it
  std::vector<std::string> light_field_options = {};  // PackageSource::options
};

// Writes the package atomically. kOutput if it cannot be written; no file is left then.
Result<void> WritePackage(const std::filesystem::path& path, const Package& package,
                          const PackageNotes& notes);

// Writes the package to the file `as`, which the caller will rename to `path`. kOutput if it cannot
// be written; a part of the file may be left then.
Result<void> WritePackageAs(const std::filesystem::path& as, const std::filesystem::path& path,
                            const Package& package, const PackageNotes& notes);

struct ReadPackageOptions {
  // True: checks that the file's checksum footer matches its bytes, which reads the whole file.
  // False is for a file that was checked before, and for tests that damage the file on purpose.
  bool check_seal = true;
};

// Reads a package. Its name is the file's name without extension. Package::light_field.folder is
// the path that the folder of the LF images (or the packed store) had when the package was made. If
// that path no longer exists, the path with the same position relative to the package is used
// instead, so that a light field and its packages may be moved together. The same holds for
// Package::source; packages of older programs do not state it, and get the folder. kInput: the file
// cannot be read, is damaged, or has another version.
Result<Package> ReadPackage(const std::filesystem::path& path,
                            const ReadPackageOptions& options = {});

}  // namespace lf
