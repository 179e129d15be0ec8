// SPDX-License-Identifier: Apache-2.0
// All parts of a store by resolution (part_file.h), for the writer and the reader of packed stores.
// Internal to this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/packed/part_file.h"
#include "lf/storage/sqlite/database.h"
#include "lf/storage/tables/settings_table.h"

namespace lf {

// Settings of a store by resolution: the number of its parts if all of them are used, and the bytes
// of each part that is used.
inline constexpr const char* kPartsKey = "parts";
inline constexpr const char* kPartBytesKey = "parts.bytes";

// Returns the number of parts that a store was planned with; 0: it is not by resolution.
Result<size_t> PlannedParts(const Settings& settings);
// Returns the sizes of the parts, coarsest first: at most PlannedParts(); none if the store is new.
Result<std::vector<uint64_t>> StatedPartBytes(const Settings& settings);

class PartSetWriter {
 public:
  // Opens the unfinished parts of a store.
  //   bytes  StatedPartBytes() of the unfinished store
  // Errors as PartWriter::Open().
  static Result<PartSetWriter> Open(const std::filesystem::path& store_path,
                                    const std::string& store, size_t part_count,
                                    const std::vector<uint64_t>& bytes);
  // Adds an LF image: its mask and smallest picture to part 0, the rest by resolution to further
  // parts. An image without fronts is in part 0 as a whole.
  Result<ImageRanges> Add(const CodedImage& image);
  // Waits until all that was added is on the disk.
  Result<void> Flush();
  // Returns the sizes of the parts as the setting kPartBytesKey states them.
  std::string TextOfBytes() const;
  // Leaves out the finest parts to which nothing was added. Their files are to be removed.
  void DropUnused();
  size_t count() const { return parts_.size(); }

 private:
  std::vector<PartWriter> parts_;
};

// Reads the encoded images of a store by resolution. Opens parts when they are needed.
class PartSetReader {
 public:
  // `database` is the file of the store.
  static Result<PartSetReader> Open(const std::filesystem::path& store_path, Database database,
                                    const Settings& settings);

  // Returns where the bytes of an LF image are. kInput: the store is damaged.
  Result<ImageRanges> RangesOf(uint32_t id, uint64_t code_bytes);
  // Replaces `code` by the first `piece_count` pieces of an encoded image. kInput as
  // PartReader::Read().
  Result<void> ReadCode(const ImageRanges& ranges, size_t piece_count, std::string* code);
  Result<void> ReadMask(const ImageRanges& ranges, std::string* mask);

 private:
  PartSetReader(std::filesystem::path path, Database database, Statement select, std::string store,
                size_t part_count);
  Result<PartReader*> Part(size_t number);

  std::filesystem::path path_;
  Database database_;
  Statement select_;
  std::string store_;  // the store's id
  size_t part_count_;
  std::vector<std::optional<PartReader>> parts_;  // set once they are opened
};

// Returns the size of each part that a store states, as it is found: smaller if the copy is
// incomplete, and 0 if the part, or one before it, is missing. kInput: a part belongs to another
// store, or part 0 is missing.
Result<std::vector<uint64_t>> FoundPartBytes(const std::filesystem::path& store_path,
                                             const Settings& settings);

}  // namespace lf
