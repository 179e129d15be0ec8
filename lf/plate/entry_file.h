// What the files of plates and of rebinned rays have in common: they begin with a head, the text of
// their entries, and the checksum of both. Internal to plate and rebinning.
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
#include "lf/plate/plate_file.h"

namespace lf::entry_file {

static_assert(std::endian::native == std::endian::little, "numbers in the file are little-endian");

struct Kind {
  std::string_view magic;  // eight characters, the last a line feed
  uint32_t version;
  // For messages.
  std::string_view noun;       // the file is ... or none
  std::string_view if_broken;  // what that means, and what to do
};

// Every head begins with this.
struct HeadBegin {
  char magic[8];
  uint32_t version;
  uint32_t text_bytes;
};
static_assert(sizeof(HeadBegin) == 16);

// The bytes of a file, or of memory, from front to back.
class Source {
 public:
  // kInput: cannot be opened, or is no regular file.
  static Result<std::unique_ptr<Source>> OfFile(const std::filesystem::path& path,
                                                const Kind& kind);
  // The bytes must outlive it; `name` is what messages call them.
  static std::unique_ptr<Source> OfBytes(std::string_view bytes, const std::string& name,
                                         const Kind& kind);
  Source(std::string name, const Kind& kind) : name_(std::move(name)), kind_(kind) {}
  ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  const std::string& name() const { return name_; }
  const Kind& kind() const { return kind_; }
  uint64_t left() const { return left_; }

  // kInput: there are fewer bytes, or they cannot be read.
  Result<void> Read(void* to, size_t size);
  // The error of bytes that are not what was written.
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

// Reads a head of so many bytes, text and checksum. kInput: of another kind or version, truncated,
// damaged, or its text is of another form.
Result<Front> ReadFront(Source& source, size_t head_bytes);

// Head, text and checksum; the beginning of the head is filled in here. The entries are as
// PlateEntries must be.
std::string FrontOf(const Kind& kind, std::string head, const PlateEntries& entries);

// A file that is written from front to back.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);

  // Does nothing after the first error, which Close() gives.
  void Write(const void* bytes, size_t size);
  void Write(std::string_view bytes) { Write(bytes.data(), bytes.size()); }

  // kOutput: the folder, the disk.
  Result<void> Close();

 private:
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  int error_ = 0;
};

}  // namespace lf::entry_file
