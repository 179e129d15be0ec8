// SPDX-License-Identifier: Apache-2.0
// The bytes of a file, on disk or in memory. Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace lf {

// Copies the bytes from `offset` on into `to`. Returns the number of bytes copied, which is less
// than the size of `to` if the file ends.
using ByteSource = std::function<size_t(uint64_t offset, std::span<uint8_t> to)>;

struct FileBytes {
  ByteSource read;
  uint64_t size_bytes = 0;
  std::string name;  // name of the file, for messages
  // The bytes of a file in memory; its data() is null for a file on disk.
  std::string_view in_memory = {};
};

// Returns all bytes of a file: `in_memory` or, if the file is on disk, `*read`, which it reads them
// into.
std::string_view ContentOf(const FileBytes& file, std::string* read);

// Returns the first `most` bytes of a file, or fewer if it ends before.
std::string StartOf(const FileBytes& file, size_t most);

// Returns a file that consists of `bytes`, which must stay as they are while it is used.
FileBytes FileInMemory(std::string_view bytes, const std::string& name);

// A file on disk, of which only the requested bytes are read.
class DiskFile {
 public:
  explicit DiskFile(const std::filesystem::path& path);
  ~DiskFile();
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;

  // Returns the errno of the last failure to open or to read the file; 0 if nothing failed.
  int error() const { return error_; }
  uint64_t size_bytes() const { return size_bytes_; }
  // Does what ByteSource does. A failure looks like the end of the file, and sets error().
  size_t Read(uint64_t offset, std::span<uint8_t> to);

 private:
  int fd_ = -1;
  int error_ = 0;
  uint64_t size_bytes_ = 0;
};

}  // namespace lf
