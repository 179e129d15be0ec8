// SPDX-License-Identifier: Apache-2.0
// The files of a store by resolution that hold the bytes of its encoded images: STORE-r0.lfs has
// the smallest picture of each LF image, and each further part the bytes that double its resolution
// (doc/formats/packed_store.md, "Stores by resolution"). Internal to this folder.
//
// A part is a head of kPartHeadBytes and the bytes of one LF image after the other, as they were
// added. The store's file states where they are, and their checksums. A part that was cut off has
// therefore lost exactly the LF images behind the cut.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/open_file.h"
#include "lf/core/result.h"
#include "lf/storage/remote/copied_file.h"

namespace lf {

inline constexpr size_t kPartHeadBytes = 64;
inline constexpr int kMostParts = 8;

// Bytes of a part that belong together, and HashBytes() of them. The number of bytes is 0 if an LF
// image has none of this kind.
struct PartRange {
  uint64_t begin = 0;
  uint64_t bytes = 0;
  uint64_t hash = 0;

  uint64_t end() const { return begin + bytes; }
};

// The places of the bytes of one LF image: those of its mask in part 0, and those of its encoded
// image, the smallest picture first.
struct ImageRanges {
  PartRange mask;
  std::vector<PartRange> pieces;  // at least one

  // Returns the part that has a piece: the first piece is in part 0, the last one in the last of
  // `part_count` parts.
  size_t PartOf(size_t piece, size_t part_count) const {
    return piece == 0 ? 0 : part_count - pieces.size() + piece;
  }
};

// Returns the column `ranges` of the table of the same name: the mask and then the pieces, with
// begin, bytes and hash of each, in 8 bytes each, the least significant first.
std::string TextOfRanges(const ImageRanges& ranges);
// Returns the ranges that the column states; nullopt if it is damaged: it has no piece, more than
// `part_count` pieces, or numbers that no part can have.
std::optional<ImageRanges> RangesOfText(std::string_view text, size_t part_count);

// Returns the path of a part: "films/a-r3.lfs" for part 3 of the store "films/a.lfs".
std::filesystem::path PartPath(const std::filesystem::path& store, size_t number);
// Returns the id of the store that a part belongs to; empty if the file cannot be read, or is no
// part.
std::string StoreOfPart(const std::filesystem::path& path);

// Appends to a part.
class PartWriter {
 public:
  // Opens the part that is written under the name `path`.
  //   bytes  number of its bytes that earlier runs committed, which are kept; all others are
  //          dropped. 0: a new part is begun
  // kOutput: the disk fails. kInput: the file is shorter, or is not this part of this store.
  static Result<PartWriter> Open(const std::filesystem::path& path, const std::string& store,
                                 size_t number, uint64_t bytes);
  uint64_t bytes() const { return bytes_; }  // size of the part with all that was added
  // Adds bytes. Returns where they are. kOutput: the disk fails.
  Result<PartRange> Add(std::string_view bytes);
  // Waits until all that was added is on the disk. kOutput: the disk fails.
  Result<void> Flush();

 private:
  PartWriter(OpenFile file, std::filesystem::path path, uint64_t bytes)
      : file_(std::move(file)), path_(std::move(path)), bytes_(bytes) {}
  Result<void> Write(std::string_view bytes);

  OpenFile file_;
  std::filesystem::path path_;
  uint64_t bytes_;
  bool is_flushed_ = true;
};

// Reads a part. For one thread.
class PartReader {
 public:
  // Opens part `number` of the store with the id `store`.
  //   url  URL of the part, if `path` is its local copy (CopiedFile)
  // kInput: the file cannot be read, or is not this part of this store. Errors of
  // CopiedFile::Read().
  static Result<PartReader> Open(const std::filesystem::path& path, const std::string& store,
                                 size_t number, const std::optional<std::string>& url = {});
  // Returns the size of the file. For a part on a server: 0 if it is not there, otherwise
  // UINT64_MAX.
  uint64_t bytes() const { return bytes_; }
  // Appends the bytes of a range to `into`. kInput: they are not all there, or have another
  // checksum. The message names the file. Errors of CopiedFile::Read().
  Result<void> Read(const PartRange& range, std::string* into);

 private:
  PartReader(CopiedFile file, uint64_t bytes) : file_(std::move(file)), bytes_(bytes) {}

  CopiedFile file_;
  uint64_t bytes_;
};

}  // namespace lf
