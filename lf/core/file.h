// SPDX-License-Identifier: Apache-2.0
// Reads and writes whole files. The results that our programs write get their final names through
// these functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

// Returns the kind of error to report if a file could not be opened or read, with the errno `code`.
// The kind is kOutput if the machine lacks something (file descriptors, memory), because any other
// file would then fail in the same way, and this file must not be reported as damaged. Otherwise
// the kind is kInput.
ErrorKind KindOfReadFailure(int code);
// Returns the kind of error to report if a library threw `thrown` while it read a file. If `thrown`
// is a std::system_error with an errno, returns KindOfReadFailure(errno), because the library may
// have been unable to start a thread. Otherwise returns kInput.
ErrorKind KindOfReadFailure(const std::exception& thrown);

// Returns the bytes of a file. The error has the kind KindOfReadFailure() if the file cannot be
// read, and kInput if it is no regular file or is larger than limit_bytes (checked before anything
// is allocated).
Result<std::string> ReadFile(const std::filesystem::path& path,
                             size_t limit_bytes = size_t{4} << 30);

// Asks the system to read the file into its page cache soon. Does not wait, and fails silently.
void AnnounceRead(const std::filesystem::path& path);

// Writes a file under a temporary name in the same folder, flushes it to the disk and renames it:
// readers see the old file or the new one, never a part. After a failure the old file is intact and
// the temporary one is gone. If the program is killed, the next write of the same file removes the
// temporary one (temporary_file.h). If `path` is a link, the file that it leads to is replaced. The
// new file gets the permissions of the old one. kOutput with the system's reason (disk full, no
// permission), or if `path` exists and is no regular file, or is a link to a missing file.
Result<void> WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// As WriteFileAtomically(), for a writer that needs a path: `write` gets the temporary name, which
// keeps the extension of `path` (libraries choose the format by it).
Result<void> WriteAtomically(
    const std::filesystem::path& path,
    const std::function<Result<void>(const std::filesystem::path&)>& write);

// Waits until the content of a file, or the names in a folder, are on the disk. kOutput on failure.
Result<void> FlushToDisk(const std::filesystem::path& path);

// Gives a complete and closed file its final name: flushes it to the disk, renames it, replacing
// any file of that name, and flushes the folder. Both names must be in one file system. kOutput on
// failure: the file then has its old name, or its new one if only the folder could not be flushed.
Result<void> RenameFlushed(const std::filesystem::path& from, const std::filesystem::path& to);

struct Renaming {
  std::filesystem::path from, to;
};
// Gives many files their final names. All of them are flushed to the disk before the first is
// renamed. After a failure some may already have their final names.
Result<void> RenameFlushed(std::span<const Renaming> files);

// Creates the folder and its parents, even if other processes create them or remove empty parents
// at the same time. kOutput if that fails or if a file has this name.
Result<void> CreateFolder(const std::filesystem::path& folder);

}  // namespace lf
