// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/part_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "lf/core/check.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/remote/store_cache.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the URL of a part of the store with this URL; nullopt if the store is local.
std::optional<std::string> UrlOfPart(const std::optional<std::string>& url, size_t number) {
  return url ? std::optional(PartUrl(*url, static_cast<int>(number))) : std::nullopt;
}

}  // namespace

Result<size_t> PlannedParts(const Settings& settings) {
  if (settings.Text(kPartsKey).empty()) return 0;
  LF_ASSIGN_OR_RETURN(const double count, settings.Number(kPartsKey, 1, kMostParts));
  return static_cast<size_t>(count);
}

Result<std::vector<uint64_t>> StatedPartBytes(const Settings& settings) {
  LF_ASSIGN_OR_RETURN(const size_t most, PlannedParts(settings));
  LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, settings.Numbers(kPartBytesKey, 0, most));
  std::vector<uint64_t> bytes;
  for (const double number : numbers) {
    constexpr double kMost = 1e15;  // smaller whole numbers are exact as double
    if (!(number >= kPartHeadBytes && number <= kMost))
      return settings.Wrong(kPartBytesKey, "sizes of files in bytes");
    bytes.push_back(static_cast<uint64_t>(number));
  }
  return bytes;
}

Result<PartSetWriter> PartSetWriter::Open(const fs::path& store_path, const std::string& store,
                                          size_t part_count, const std::vector<uint64_t>& bytes) {
  PartSetWriter writer;
  for (size_t number = 0; number < part_count; ++number) {
    LF_ASSIGN_OR_RETURN(PartWriter part,
                        PartWriter::Open(UnfinishedPath(PartPath(store_path, number)), store,
                                         number, number < bytes.size() ? bytes[number] : 0));
    writer.parts_.push_back(std::move(part));
  }
  return writer;
}

Result<ImageRanges> PartSetWriter::Add(const CodedImage& image) {
  ImageRanges ranges;
  // Half floats are not reduced (storage/load/packed_store.h). Part 0 also has the smallest
  // pictures for which there is no part.
  const size_t front_count = image.values == StoredValues::kHalf
                                 ? 0
                                 : std::min(image.front_ends.size(), parts_.size() - 1);
  std::vector<uint64_t> ends(image.front_ends.end() - static_cast<ptrdiff_t>(front_count),
                             image.front_ends.end());
  ends.push_back(image.code.size());
  ranges.pieces.resize(ends.size());
  uint64_t begin = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    LF_ASSIGN_OR_RETURN(ranges.pieces[i],
                        parts_[ranges.PartOf(i, parts_.size())].Add(
                            std::string_view(image.code).substr(begin, ends[i] - begin)));
    begin = ends[i];
  }
  if (!image.mask.empty()) {
    LF_ASSIGN_OR_RETURN(ranges.mask, parts_[0].Add(image.mask));
  }
  return ranges;
}

Result<void> PartSetWriter::Flush() {
  for (PartWriter& part : parts_) LF_RETURN_IF_ERROR(part.Flush());
  return {};
}

std::string PartSetWriter::TextOfBytes() const {
  std::vector<uint64_t> bytes;
  for (const PartWriter& part : parts_) bytes.push_back(part.bytes());
  return fmt::format("{}", fmt::join(bytes, " "));
}

void PartSetWriter::DropUnused() {
  while (parts_.size() > 1 && parts_.back().bytes() == kPartHeadBytes) parts_.pop_back();
}

PartSetReader::PartSetReader(fs::path path, std::optional<std::string> url, Database database,
                             Statement select, std::string store, size_t part_count)
    : path_(std::move(path)),
      url_(std::move(url)),
      database_(std::move(database)),
      select_(std::move(select)),
      store_(std::move(store)),
      part_count_(part_count),
      parts_(part_count) {}

Result<PartSetReader> PartSetReader::Open(const fs::path& store_path, Database database,
                                          const Settings& settings) {
  LF_ASSIGN_OR_RETURN(const size_t part_count, PlannedParts(settings));
  LF_ASSIGN_OR_RETURN(Statement select, database.Prepare("select ranges from ranges where id = ?"));
  LF_ASSIGN_OR_RETURN(std::optional<std::string> url, UrlOfStore(store_path));
  return PartSetReader(store_path, std::move(url), std::move(database), std::move(select),
                       settings.Text("store"), part_count);
}

Result<ImageRanges> PartSetReader::RangesOf(uint32_t id, uint64_t code_bytes) {
  select_.Bind(0, int64_t{id});
  const auto damaged = [&](std::string_view fault) {
    return database_.Fault(
        fmt::format("is damaged: {} of LF image {}; copy or make it again", fault, id));
  };
  LF_ASSIGN_OR_RETURN(const bool has_row, select_.Step());
  if (!has_row) return damaged("it states no range of bytes");
  LF_ASSIGN_OR_RETURN(const std::string_view text, select_.Blob(0));
  const std::optional<ImageRanges> ranges = RangesOfText(text, part_count_);
  select_.Reset();
  if (!ranges) return damaged("it states an impossible range of bytes");
  uint64_t bytes = ranges->mask.bytes;
  for (const PartRange& piece : ranges->pieces) bytes += piece.bytes;
  if (bytes != code_bytes) return damaged("it states two different sizes");
  return *ranges;
}

Result<PartReader*> PartSetReader::Part(size_t number) {
  if (!parts_[number]) {
    LF_ASSIGN_OR_RETURN(parts_[number], PartReader::Open(PartPath(path_, number), store_, number,
                                                         UrlOfPart(url_, number)));
  }
  return &*parts_[number];
}

Result<void> PartSetReader::ReadCode(const ImageRanges& ranges, size_t piece_count,
                                     std::string* code) {
  LF_CHECK(piece_count <= ranges.pieces.size());
  code->clear();
  for (size_t i = 0; i < piece_count; ++i) {
    LF_ASSIGN_OR_RETURN(PartReader* const part, Part(ranges.PartOf(i, part_count_)));
    LF_RETURN_IF_ERROR(part->Read(ranges.pieces[i], code));
  }
  return {};
}

Result<void> PartSetReader::ReadMask(const ImageRanges& ranges, std::string* mask) {
  mask->clear();
  if (ranges.mask.bytes == 0) return {};
  LF_ASSIGN_OR_RETURN(PartReader* const part, Part(0));
  return part->Read(ranges.mask, mask);
}

Result<std::vector<uint64_t>> FoundPartBytes(const fs::path& store_path, const Settings& settings) {
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> stated, StatedPartBytes(settings));
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> url, UrlOfStore(store_path));
  std::vector<uint64_t> found(stated.size());
  for (size_t number = 0; number < stated.size(); ++number) {
    const fs::path path = PartPath(store_path, number);
    std::error_code error;
    if (!url && number > 0 && !fs::exists(path, error) && !error) break;
    LF_ASSIGN_OR_RETURN(const PartReader part, PartReader::Open(path, settings.Text("store"),
                                                                number, UrlOfPart(url, number)));
    if (url && part.bytes() == 0) {
      if (number > 0) break;
      return InputError(
          fmt::format("{}: is not on the server, although the store needs it: copy all files of "
                      "the store there",
                      ShownUrl(*UrlOfPart(url, number))));
    }
    found[number] = std::min(part.bytes(), stated[number]);
  }
  return found;
}

}  // namespace lf
