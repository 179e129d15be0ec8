// Whole files in and out. The only way anything of ours gets its final name on disk.
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

// Returns the kind of a failed open or read with this errno. kOutput: the machine lacks something
// (open files, memory), and any other file would fail, too: no good file counts as a broken one.
// kInput: everything else.
ErrorKind KindOfReadFailure(int code);
// Returns the kind of an exception that a library threw while it read. It may have wanted a thread.
ErrorKind KindOfReadFailure(const std::exception& thrown);

// The bytes of a file. KindOfReadFailure() or kInput if it cannot be read, is no regular file or is
// larger than limit_bytes (checked before anything is allocated).
Result<std::string> ReadFile(const std::filesystem::path& path,
                             size_t limit_bytes = size_t{4} << 30);

// Asks the system to read the file into its cache soon. Does not wait, and fails silently.
void AnnounceRead(const std::filesystem::path& path);

// Writes a file under a temporary name in the same folder, flushes it to the disk and renames it:
// readers see the old file or the new one, never a part. After a failure the old file is intact
// and the temporary one is gone. After a kill the next write of the same file removes it
// (temporary_file.h). Follows a link, and keeps the permissions of the old file.
// kOutput: the system's reason (disk full, no permission), or something that is no file has the
// name.
Result<void> WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// The same for a writer that wants a path: `write` is given the temporary name, which keeps the
// extension of `path` (libraries choose the format by it).
Result<void> WriteAtomically(
    const std::filesystem::path& path,
    const std::function<Result<void>(const std::filesystem::path&)>& write);

// Waits until the content of a file, or the names in a folder, are on the disk. kOutput.
Result<void> FlushToDisk(const std::filesystem::path& path);

// Gives a complete and closed file its final name: flushes it to the disk, renames it over what has
// the name, and flushes the folder. Both in one file system. kOutput; the file keeps its name then.
Result<void> RenameFlushed(const std::filesystem::path& from, const std::filesystem::path& to);

// The final names of many files: all of them are on the disk before the first gets its own. After a
// failure some may have it.
struct Renaming {
  std::filesystem::path from, to;
};
Result<void> RenameFlushed(std::span<const Renaming> files);

// Creates the folder and its parents. kOutput if that fails or a file has the name.
Result<void> CreateFolder(const std::filesystem::path& folder);

}  // namespace lf
