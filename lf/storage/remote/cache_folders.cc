// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/cache_folders.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kInUse = "in_use";

// A folder that is removed when the program ends.
struct RemovedFolder {
  fs::path path;
  ~RemovedFolder() {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
  }
};

// A store that no program used within the last day.
struct OldStore {
  fs::file_time_type used;
  uint64_t bytes = 0;
  fs::path folder;
};

// Returns the bytes that the files of a folder take on the disk, without holes.
uint64_t BytesOnDisk(const fs::path& folder) {
  constexpr uint64_t kBlockBytes = 512;
  uint64_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    struct stat status {};
    if (::lstat(it->path().c_str(), &status) == 0)
      bytes += static_cast<uint64_t>(status.st_blocks) * kBlockBytes;
  }
  return bytes;
}

// On a disk without locks, only the time when a store was opened tells whether a program uses it.
constexpr auto kStaysWithoutLocks = std::chrono::hours(24 * 30);

// Removes the folder of a store, unless a program uses it. Returns true if it is gone.
//   age  time since a program opened the store
bool RemoveStore(const fs::path& folder, fs::file_time_type::duration age) {
  const int fd = ::open((folder / kInUse).c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return false;
  std::error_code error;
  bool is_free = ::flock(fd, LOCK_EX | LOCK_NB) == 0;
  if (!is_free && errno != EWOULDBLOCK) is_free = age > kStaysWithoutLocks;
  if (is_free) fs::remove_all(folder, error);
  ::close(fd);
  return is_free && !error;
}

}  // namespace

Result<fs::path> DefaultCacheFolder() {
  constexpr const char* kBelow = "lfrendertools/stores";
  const auto absolute = [](const char* name) {
    const char* const value = std::getenv(name);
    const fs::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : fs::path();
  };
  if (const fs::path cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache / kBelow;
  if (const fs::path home = absolute("HOME"); !home.empty()) return home / ".cache" / kBelow;
  return OutputError(
      "the environment names no folder for copies of stores (XDG_CACHE_HOME or HOME): name one "
      "({store_cache})");
}

Result<fs::path> TemporaryCacheFolder() {
  static std::mutex mutex;
  static RemovedFolder folder;
  const std::lock_guard lock(mutex);
  if (!folder.path.empty()) return folder.path;
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "lfrendertools-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr)
    return OutputError(fmt::format("{}: cannot be made: {}", name,
                                   error ? error.message() : std::strerror(errno)));
  folder.path = name;
  return folder.path;
}

Result<void> MakeCacheFolder(const fs::path& folder) {
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  std::error_code error;
  fs::permissions(folder, fs::perms::owner_all, error);
  if (error)
    return OutputError(
        fmt::format("{}: belongs to another user: {}", folder.string(), error.message()));
  return {};
}

Result<void> UseCacheFolder(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> used;
  const std::lock_guard guard(mutex);
  const fs::path path = folder / kInUse;
  constexpr mode_t kOwnerOnly = 0600;
  // The descriptor stays open, and the lock is held, until the program ends.
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnerOnly);
  if (fd < 0 || ::futimens(fd, nullptr) != 0) {
    const Error error =
        OutputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    if (fd >= 0) ::close(fd);
    return error;
  }
  if (used.insert(folder).second)
    // Fails only while the folder is being removed, and on disks without locks.
    ::flock(fd, LOCK_SH | LOCK_NB);
  else
    ::close(fd);
  return {};
}

void RemoveOldStores(const fs::path& cache, uint64_t most_bytes) {
  constexpr auto kStays = std::chrono::hours(24);
  const fs::file_time_type now = fs::file_time_type::clock::now();
  std::vector<OldStore> old;
  uint64_t sum_bytes = 0;
  std::error_code error;
  for (fs::directory_iterator it(cache, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const fs::file_time_type used = fs::last_write_time(it->path() / kInUse, ignored);
    if (ignored) continue;  // is no folder of a store
    const uint64_t bytes = BytesOnDisk(it->path());
    sum_bytes += bytes;
    if (now - used > kStays) old.push_back({used, bytes, it->path()});
  }
  std::sort(old.begin(), old.end(),
            [](const OldStore& a, const OldStore& b) { return a.used < b.used; });
  for (const OldStore& store : old) {
    if (sum_bytes <= most_bytes) return;
    if (!RemoveStore(store.folder, now - store.used)) continue;
    sum_bytes -= store.bytes;
    LogDebug("{}: removed, because it was not used for the longest time", store.folder.string());
  }
}

}  // namespace lf
