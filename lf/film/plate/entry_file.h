// SPDX-License-Identifier: Apache-2.0
// Common part of the files of plates, of rebinned rays and of kept pixels: these files begin with a
// head, the text of their entries, and the checksum of both. Internal to film/plate and rebinning.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "lf/core/result.h"
#include "lf/film/plate/plate_file.h"

namespace lf::entry_file {

static_assert(std::endian::native == std::endian::little, "numbers in the file are little-endian");

struct Kind {
  std::string_view magic;  // eight characters, the last a line feed
  uint32_t version;
  // Words for error messages about such a file:
  std::string_view noun;  // the kind of file, such as "plate" in "is no plate"
  // The consequence of damage. Callers add what the user can do, which depends on whether the file
  // is a checkpoint, or a plate that lfmerge reads.
  std::string_view if_broken;
  uint32_t later_version = 0;  // a second version that is read, version + 1; 0: there is none
};

// The head of every file, whether of plates, rebinned rays or kept pixels, begins with these
// fields.
struct HeadBegin {
  char magic[8];
  uint32_t version;
  uint32_t text_bytes;
};
static_assert(sizeof(HeadBegin) == 16);

// Reads the bytes of a file, or of memory, from front to back.
class Source {
 public:
  // Opens a file. kInput if it cannot be opened or is no regular file.
  static Result<std::unique_ptr<Source>> OfFile(const std::filesystem::path& path,
                                                const Kind& kind);
  // Reads from `bytes`, which must outlive the source; messages call them `name`.
  static std::unique_ptr<Source> OfBytes(std::string_view bytes, const std::string& name,
                                         const Kind& kind);
  Source(std::string name, const Kind& kind) : name_(std::move(name)), kind_(kind) {}
  ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  const std::string& name() const { return name_; }
  const Kind& kind() const { return kind_; }
  uint64_t left() const { return left_; }

  // Reads the next `size` bytes. kInput if fewer are left, or if they cannot be read.
  Result<void> Read(void* to, size_t size);
  // Returns the error (kInput) that says that the file is damaged, why, and Kind::if_broken.
  Error Damaged(const std::string& reason) const;

 private:
  std::string name_;
  Kind kind_;
  int fd_ = -1;
  std::string_view memory_;
  uint64_t left_ = 0;
};

struct Front {
  std::string head;
  PlateEntries entries;
};

// Reads a head of `head_bytes` bytes, the entries and the checksum of both. kInput if the file is
// truncated, damaged, or of another kind or version, or if its text is not made of "key: value"
// lines with different keys.
Result<Front> ReadFront(Source& source, size_t head_bytes);

// Returns the first bytes of a file: head, text of the entries, and checksum of both. Writes magic,
// version and text_bytes (HeadBegin) into the head. Keys and values must be as PlateEntries
// demands.
std::string FrontOf(const Kind& kind, std::string head, const PlateEntries& entries);

// Writes a file from front to back.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);

  // Does nothing after the first error, which Close() returns.
  void Write(const void* bytes, size_t size);
  void Write(std::string_view bytes) { Write(bytes.data(), bytes.size()); }

  // Gives all bytes to the system, without waiting for the disk; the destructor closes the file.
  // kOutput if the file could not be created or written.
  Result<void> Close();

 private:
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  int error_ = 0;
};

}  // namespace lf::entry_file
