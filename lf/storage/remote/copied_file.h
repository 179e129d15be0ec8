// SPDX-License-Identifier: Apache-2.0
// Reads ranges of a file whose checksums are known, from a local file or, through a local copy that
// grows, from a web server.
//
// Nothing but the bytes tells whether a range of the local copy is there: a range that was never
// fetched, or whose writing was interrupted, fails its checksum and is fetched. Any number of
// threads and processes may share a local copy without a lock.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "lf/core/open_file.h"
#include "lf/core/result.h"
#include "lf/storage/remote/remote_file.h"

namespace lf {

// State of a range of a file.
enum class RangeState {
  kRead,      // its bytes have the checksum
  kNotThere,  // it lies beyond the end of the file, or was never copied
  kDamaged,   // its bytes have another checksum
};

// For one thread.
class CopiedFile {
 public:
  // Opens a local file.
  //   url  server of the file, of which `path` is the copy; unset: the file is local. If the copy
  //        cannot be written, ranges are read without keeping them, and a warning says so once in
  //        the life of the program
  // kInput, or kOutput if the machine failed: the local file cannot be read. Errors of
  // RemoteFile::Open().
  static Result<CopiedFile> Open(const std::filesystem::path& path,
                                 const std::optional<std::string>& url,
                                 const RemoteOptions& options = {});

  // Appends the `count` bytes from `begin` on to `into`; HashBytes() of them is `hash`. Unless it
  // returns kRead, nothing is appended. A range of a server is fetched again if its first bytes are
  // wrong. kNotThere and kDamaged are also returned for a file on a server that is missing, not
  // complete or damaged. Local ranges that hold zeros alone are kNotThere: they are the holes of a
  // copy without its server. Takes no memory for ranges that no file holds. kInput: `begin` is
  // above 2^62, or `count` above 4 GiB. Errors of RemoteFile::Read(), and of reading the local
  // file.
  Result<RangeState> Read(uint64_t begin, uint64_t count, uint64_t hash, std::string* into);

  // Describes the last range that was not read, naming the file or the URL, and what to do.
  const std::string& Complaint() const { return complaint_; }
  // Returns the size of the local file; 0: there is no copy.
  uint64_t local_bytes() const;

 private:
  CopiedFile(std::filesystem::path path, OpenFile file, std::optional<RemoteFile> remote)
      : path_(std::move(path)), file_(std::move(file)), remote_(std::move(remote)) {}
  Result<RangeState> ReadLocal(uint64_t begin, uint64_t count, uint64_t hash, std::string* into);
  Result<RangeState> Fetch(uint64_t begin, uint64_t count, uint64_t hash, std::string* into);
  void KeepRange(uint64_t begin, const std::string& bytes);

  std::filesystem::path path_;
  OpenFile file_;         // not open: there is no local copy
  bool is_kept_ = false;  // true if what is fetched is written to the local file
  std::optional<RemoteFile> remote_;
  std::string complaint_;
};

}  // namespace lf
