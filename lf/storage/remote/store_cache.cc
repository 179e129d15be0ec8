// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/store_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "lf/core/file.h"
#include "lf/core/file_lock.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/core/quantities.h"
#include "lf/storage/remote/cache_folders.h"
#include "lf/storage/remote/remote_file.h"
#include "lf/storage/remote/store_note.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kPartialExtension = ".partial";

std::string SystemReason() { return std::strerror(errno); }

// Removes what was copied of a store but its tables and what belongs to `kept`.
void RemoveCopies(const fs::path& folder, const std::string& stem, const fs::path& kept) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    const bool is_part = name.starts_with(stem + "-r") && name.ends_with(".lfs");
    const bool is_partial = name.ends_with(kPartialExtension) && it->path() != kept;
    std::error_code ignored;
    if (is_part || is_partial) fs::remove(it->path(), ignored);
  }
}

// Tells how much of a download that takes long is there.
class DownloadProgress {
 public:
  void Tell(const std::string& url, uint64_t there, uint64_t size_bytes) {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::seconds(5);
    LogInfo("{}: copied {}B of the {}B of its tables", ShownUrl(url),
            ShortNumber(static_cast<double>(there)), ShortNumber(static_cast<double>(size_bytes)));
  }

 private:
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(3);
};

// The copy of one store.
class StoreCopy {
 public:
  StoreCopy(std::string url, fs::path folder, const StoreCacheOptions& options)
      : url_(std::move(url)),
        folder_(std::move(folder)),
        stem_(StemOfUrl(url_)),
        store_(folder_ / (stem_ + ".lfs")),
        options_(options) {}

  const fs::path& store() const { return store_; }

  // Returns true if the error of the last call is that files cannot be written.
  bool cannot_write() const { return cannot_write_; }

  Result<void> Bring(RemoteFile* remote) {
    if (Result<void> made = MakeCacheFolder(folder_); !made) return CannotWrite(made.error());
    if (Result<void> used = UseCacheFolder(folder_); !used) return CannotWrite(used.error());
    constexpr int kAttemptsWithCopy = 2;
    const std::optional<StoreNote> note = NoteOfCopy();
    const Result<RemoteFacts> facts = note ? remote->Facts(kAttemptsWithCopy) : remote->Facts();
    if (!facts && remote->fault() == TransferFault::kUnreachable && note) {
      LogWarning("{}; its copy in {} is used", facts.error().message, folder_.string());
      return {};
    }
    if (!facts) return facts.error();
    const StoreNote wanted = {url_, facts->validator, facts->size_bytes.value_or(0)};
    LF_RETURN_IF_ERROR(CheckSize(*facts));
    if (IsCurrent(note, wanted)) return KeepUrl(*note, wanted);
    LF_ASSIGN_OR_RETURN(const std::optional<FileLock> lock, Lock());
    if (IsCurrent(NoteOfCopy(), wanted)) return {};
    if (note && !wanted.validator.empty())
      LogInfo("{}: has changed on the server: is copied again", ShownUrl(url_));
    return Download(remote, wanted);
  }

 private:
  Error CannotWrite(const Error& error) {
    cannot_write_ = true;
    return error;
  }

  // Returns what is known of the copy; nullopt if there is no complete one.
  std::optional<StoreNote> NoteOfCopy() const {
    Result<std::optional<StoreNote>> note = ReadStoreNote(store_);
    std::error_code error;
    if (!note || !*note || fs::file_size(store_, error) != (*note)->size_bytes || error)
      return std::nullopt;
    return *std::move(note);
  }

  static bool IsCurrent(const std::optional<StoreNote>& note, const StoreNote& wanted) {
    return note && !wanted.validator.empty() && note->validator == wanted.validator &&
           note->size_bytes == wanted.size_bytes;
  }

  // Notes the URL with which the server was asked last, because signed URLs expire.
  Result<void> KeepUrl(const StoreNote& note, const StoreNote& wanted) {
    if (note.url == wanted.url) return {};
    if (Result<void> written = WriteStoreNote(store_, wanted); !written)
      return CannotWrite(written.error());
    return {};
  }

  Result<void> CheckSize(const RemoteFacts& facts) const {
    if (!facts.size_bytes)
      return InputError(fmt::format("{}: the server does not state its size", ShownUrl(url_)));
    if (*facts.size_bytes <= options_.most_table_bytes) return {};
    return InputError(fmt::format(
        "{}: has {}B, more than the {}B that are copied at once: the LF images are in the file "
        "itself; make the store by resolution ({{lfcompressor by_resolution}}), so that they are "
        "read "
        "as they are needed, or download the file",
        ShownUrl(url_), ShortNumber(static_cast<double>(*facts.size_bytes)),
        ShortNumber(static_cast<double>(options_.most_table_bytes))));
  }

  // Waits until no other process downloads the tables.
  Result<std::optional<FileLock>> Lock() {
    constexpr auto kBetween = std::chrono::milliseconds(200);
    const fs::path path = folder_ / "lock";
    for (bool has_told = false;; has_told = true) {
      Result<FileLock> lock = FileLock::Take(path);
      if (lock) return std::optional(*std::move(lock));
      if (!FileLock::IsHeld(path)) return CannotWrite(lock.error());
      if (!has_told)
        LogInfo("{}: waits for another process that copies its tables", ShownUrl(url_));
      if (AreRemoteReadsStopped())
        return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", ShownUrl(url_))};
      std::this_thread::sleep_for(kBetween);
    }
  }

  Result<void> Download(RemoteFile* remote, const StoreNote& wanted) {
    // Only the bytes of the same version are continued.
    const fs::path partial =
        folder_ / fmt::format("{}-{:016x}{}", stem_,
                              HashBytes(fmt::format("{} {}", wanted.validator, wanted.size_bytes)),
                              kPartialExtension);
    std::error_code ignored;
    if (wanted.validator.empty()) fs::remove(partial, ignored);
    RemoveCopies(folder_, stem_, partial);
    LF_RETURN_IF_ERROR(DownloadInto(partial, remote, wanted));
    if (Result<void> renamed = RenameFlushed(partial, store_); !renamed)
      return CannotWrite(renamed.error());
    if (Result<void> written = WriteStoreNote(store_, wanted); !written)
      return CannotWrite(written.error());
    return {};
  }

  Result<void> DownloadInto(const fs::path& partial, RemoteFile* remote, const StoreNote& wanted) {
    constexpr uint64_t kMostAtOnce = uint64_t{8} << 20;
    constexpr mode_t kOwnerOnly = 0600;
    const int fd = ::open(partial.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnerOnly);
    struct stat status {};
    if (fd < 0 || ::fstat(fd, &status) != 0)
      return CannotWrite(
          OutputError(fmt::format("{}: cannot be created: {}", partial.string(), SystemReason())));
    auto there = static_cast<uint64_t>(status.st_size);
    if (there > wanted.size_bytes) there = 0;
    DownloadProgress progress;
    std::string bytes;
    Result<void> result;
    while (result && there < wanted.size_bytes) {
      result = remote->Read(there, std::min(kMostAtOnce, wanted.size_bytes - there), &bytes);
      // Bytes that came before an error are kept for the next call.
      if (Result<void> written = Write(fd, there, bytes, partial); !written) result = written;
      there += bytes.size();
      progress.Tell(url_, there, wanted.size_bytes);
    }
    ::close(fd);
    return result;
  }

  Result<void> Write(int fd, uint64_t begin, const std::string& bytes, const fs::path& path) {
    for (size_t written = 0; written < bytes.size();) {
      const ssize_t step = ::pwrite(fd, bytes.data() + written, bytes.size() - written,
                                    static_cast<off_t>(begin + written));
      if (step < 0 && errno == EINTR) continue;
      if (step < 0) {
        const Error error =
            OutputError(fmt::format("{}: cannot be written: {}", path.string(), SystemReason()));
        std::error_code ignored;
        fs::remove(path, ignored);
        return CannotWrite(error);
      }
      written += static_cast<size_t>(step);
    }
    return {};
  }

  const std::string url_;
  const fs::path folder_;
  const std::string stem_;
  const fs::path store_;
  const StoreCacheOptions& options_;
  bool cannot_write_ = false;
};

}  // namespace

Result<fs::path> OpenRemoteStore(const std::string& url, const StoreCacheOptions& options) {
  LF_RETURN_IF_ERROR(CheckStoreUrl(url));
  LF_ASSIGN_OR_RETURN(RemoteFile remote, RemoteFile::Open(url, options.remote));
  const Result<fs::path> cache = options.folder ? *options.folder : DefaultCacheFolder();
  Error reason;
  if (cache) {
    StoreCopy copy(url, *cache / FolderNameOfUrl(url), options);
    const Result<void> brought = copy.Bring(&remote);
    if (brought && !options.folder) RemoveOldStores(*cache, options.most_cached_bytes);
    if (brought) return copy.store();
    if (!copy.cannot_write()) return brought.error();
    reason = brought.error();
  } else {
    reason = cache.error();
  }
  LogWarning("{}; {} is copied into a temporary folder, and again by the next call", reason.message,
             ShownUrl(url));
  LF_ASSIGN_OR_RETURN(const fs::path temporary, TemporaryCacheFolder());
  StoreCopy copy(url, temporary / FolderNameOfUrl(url), options);
  LF_RETURN_IF_ERROR(copy.Bring(&remote));
  return copy.store();
}

Result<std::optional<std::string>> UrlOfStore(const fs::path& store) {
  LF_ASSIGN_OR_RETURN(const std::optional<StoreNote> note, ReadStoreNote(store));
  return note ? std::optional(note->url) : std::nullopt;
}

}  // namespace lf
