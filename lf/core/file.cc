// SPDX-License-Identifier: Apache-2.0
#include "lf/core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>
#include <vector>

#include "lf/core/files_nearby.h"
#include "lf/core/open_file.h"
#include "lf/core/temporary_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

std::string SystemReason() { return std::strerror(errno); }

fs::path ParentOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Returns the error with one name in its message replaced by another.
Error Renamed(Error error, const std::string& from, const std::string& to) {
  for (size_t at = error.message.find(from); at != std::string::npos;
       at = error.message.find(from, at + to.size()))
    error.message.replace(at, from.size(), to);
  return error;
}

// Returns the file that a write to `path` replaces: `path`, or if it is a link, the file that it
// leads to. kOutput for a link to a missing file, and for a folder, a device or a pipe (the rename
// would replace a device or a pipe by a file).
Result<fs::path> WriteTarget(const fs::path& path) {
  std::error_code error;
  fs::path target = path;
  if (fs::is_symlink(path, error)) {
    target = fs::canonical(path, error);
    if (error)
      return OutputError(
          fmt::format("{}: is a link to a file that cannot be found ({}): remove the link, or give "
                      "another name",
                      path.string(), error.message()));
  }
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    return OutputError(fmt::format(
        "{}: is a folder or a device, and cannot be replaced by a file: give another name",
        path.string()));
  return target;
}

// Gives the new file the permissions of the old one, if that exists.
void CopyPermissions(const fs::path& old_file, const fs::path& new_file) {
  struct stat old {};
  if (::stat(old_file.c_str(), &old) == 0) ::chmod(new_file.c_str(), old.st_mode & 0777);
}

}  // namespace

ErrorKind KindOfReadFailure(int code) {
  for (const int lack : {EMFILE, ENFILE, ENOMEM, EAGAIN, ENOBUFS, ENOLCK})
    if (code == lack) return ErrorKind::kOutput;
  return ErrorKind::kInput;
}

ErrorKind KindOfReadFailure(const std::exception& thrown) {
  const auto* const refused = dynamic_cast<const std::system_error*>(&thrown);
  const bool has_errno =
      refused != nullptr && (refused->code().category() == std::generic_category() ||
                             refused->code().category() == std::system_category());
  return has_errno ? KindOfReadFailure(refused->code().value()) : ErrorKind::kInput;
}

void AnnounceRead(const fs::path& path) {
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() >= 0) ::posix_fadvise(file.get(), 0, 0, POSIX_FADV_WILLNEED);
}

Result<std::string> ReadFile(const fs::path& path, size_t limit_bytes) {
  // O_NONBLOCK, because opening a named pipe would wait for its writer.
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
    const int code = errno;
    const bool is_missing = code == ENOENT || code == ENOTDIR;
    return Error{KindOfReadFailure(code),
                 fmt::format("{}: cannot be read: {}{}", path.string(), std::strerror(code),
                             is_missing ? FilesNearby(path) : "")};
  }
  if (!S_ISREG(status.st_mode))
    return InputError(fmt::format("{}: is a folder or a device, expected a file", path.string()));
  if (static_cast<uint64_t>(status.st_size) > limit_bytes)
    return InputError(fmt::format(
        "{}: has {} bytes, but a file of this kind has at most {}: is it the right file?",
        path.string(), status.st_size, limit_bytes));
  std::string bytes(static_cast<size_t>(status.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      return Error{KindOfReadFailure(errno),
                   fmt::format("{}: cannot be read: {}", path.string(), SystemReason())};
    if (n == 0) break;  // the file became shorter while it was read
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

Result<void> WriteFileAtomically(const fs::path& path, std::string_view bytes) {
  return WriteAtomically(path, [bytes](const fs::path& temporary) -> Result<void> {
    const OpenFile file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.get() < 0)
      return OutputError(
          fmt::format("{}: cannot be created: {}", temporary.string(), SystemReason()));
    size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t n = ::write(file.get(), bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0)
        return OutputError(
            fmt::format("{}: cannot be written: {}", temporary.string(), SystemReason()));
      done += static_cast<size_t>(n);
    }
    return {};
  });
}

Result<void> WriteAtomically(const fs::path& path,
                             const std::function<Result<void>(const fs::path&)>& write) {
  LF_ASSIGN_OR_RETURN(const fs::path target, WriteTarget(path));
  std::error_code error;
  if (const fs::path folder = ParentOf(target); !fs::exists(folder, error) && !error)
    return OutputError(fmt::format(
        "{}: cannot be written: the folder {} does not exist: make it, or give another name",
        path.string(), folder.string()));
  TemporaryFile temporary(target);
  const Result<void> written = write(temporary.path());
  if (!written) return Renamed(written.error(), temporary.path().string(), path.string());
  CopyPermissions(target, temporary.path());
  LF_RETURN_IF_ERROR(RenameFlushed(temporary.path(), target));
  temporary.Keep();
  return {};
}

Result<void> FlushToDisk(const fs::path& path) {
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0 || ::fsync(file.get()) != 0)
    return OutputError(
        fmt::format("{}: cannot be flushed to the disk: {}", path.string(), SystemReason()));
  return {};
}

Result<void> RenameFlushed(const fs::path& from, const fs::path& to) {
  const Renaming one[] = {{from, to}};
  return RenameFlushed(one);
}

Result<void> RenameFlushed(std::span<const Renaming> files) {
  for (const Renaming& file : files) LF_RETURN_IF_ERROR(FlushToDisk(file.from));
  std::set<fs::path> folders;
  for (const auto& [from, to] : files) {
    if (::rename(from.c_str(), to.c_str()) != 0)
      return OutputError(fmt::format("{}: the complete file cannot be renamed to this name: {}",
                                     to.string(), SystemReason()));
    folders.insert(ParentOf(to));
  }
  // A rename is on the disk only after the folder has been flushed.
  for (const fs::path& folder : folders) LF_RETURN_IF_ERROR(FlushToDisk(folder));
  return {};
}

namespace {

// Tries once to create the folder and its missing parents. Returns false if another process removed
// one of them in the meantime.
Result<bool> TryToCreateFolder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path())
    missing.push_back(at);
  fs::create_directories(folder, error);
  if (error == std::errc::no_such_file_or_directory) return false;
  if (error)
    return OutputError(
        fmt::format("{}: cannot be created as a folder: {}", folder.string(), error.message()));
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (!fs::is_directory(status))
    return OutputError(fmt::format("{}: cannot be created as a folder: {}", folder.string(),
                                   error ? error.message() : "a file has this name"));
  // Until the parent of a new folder is flushed, a crash can lose the folder with all that is in
  // it.
  for (const fs::path& made : missing) {
    const Result<void> flushed = FlushToDisk(ParentOf(made));
    if (!flushed && !fs::exists(ParentOf(made), error)) return false;
    LF_RETURN_IF_ERROR(flushed);
  }
  return true;
}

}  // namespace

Result<void> CreateFolder(const fs::path& folder) {
  constexpr int kMostTries = 1000;
  for (int tries = 0; tries < kMostTries; ++tries) {
    LF_ASSIGN_OR_RETURN(const bool is_created, TryToCreateFolder(folder));
    if (is_created) return {};
  }
  return OutputError(fmt::format(
      "{}: cannot be created as a folder, because another program removes it again and again: end "
      "that program, or give another name",
      folder.string()));
}

}  // namespace lf
