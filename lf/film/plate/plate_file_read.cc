// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/film/plate/entry_file.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/plate_format.h"

namespace lf {
namespace fs = std::filesystem;

using namespace plate_format;

PlateReader::PlateReader(std::unique_ptr<entry_file::Source> source) : source_(std::move(source)) {}
PlateReader::PlateReader(PlateReader&&) noexcept = default;
PlateReader& PlateReader::operator=(PlateReader&&) noexcept = default;
PlateReader::~PlateReader() = default;

const std::string* FindEntry(const PlateEntries& entries, std::string_view key) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [key](const auto& entry) { return entry.first == key; });
  return found == entries.end() ? nullptr : &found->second;
}

Result<PlateReader> PlateReader::Open(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(std::unique_ptr<entry_file::Source> source,
                      entry_file::Source::OfFile(path, kKind));
  PlateReader reader(std::move(source));
  LF_RETURN_IF_ERROR(reader.ReadHead());
  return reader;
}

Result<PlateReader> PlateReader::OpenBytes(std::string_view bytes, const std::string& name) {
  PlateReader reader(entry_file::Source::OfBytes(bytes, name, kKind));
  LF_RETURN_IF_ERROR(reader.ReadHead());
  return reader;
}

Result<void> PlateReader::ReadHead() {
  LF_ASSIGN_OR_RETURN(entry_file::Front front, entry_file::ReadFront(*source_, sizeof(Head)));
  Head head;
  std::memcpy(&head, front.head.data(), sizeof(head));
  const std::optional<PlateKind> kind = PlateKindOf(head.channels);
  if (head.width < 1 || head.width > kMaxSide || head.height < 1 || head.height > kMaxSide || !kind)
    return InputError(fmt::format(
        "{}: states {} x {} elements with {} channels, expected 3, 4, 8 or 10 channels, and width "
        "and height from 1 to {}",
        source_->name(), head.width, head.height, head.channels, kMaxSide));
  const uint64_t most_rows = 1 + kChunkWords / (uint64_t{head.width} * head.channels);
  if (head.rows_per_chunk < 1 || head.rows_per_chunk > most_rows)
    return InputError(fmt::format("{}: states chunks of {} rows, expected 1 to {}", source_->name(),
                                  head.rows_per_chunk, most_rows));
  // Refuses a file that is too short for the size of plate that its head states, before anybody
  // allocates a plate of this size.
  const bool has_gaps = head.version == kVersionWithGaps;
  const uint64_t chunks = uint64_t{(head.height - 1) / head.rows_per_chunk + 1};
  const uint64_t least =
      chunks * sizeof(ChunkHead) * (has_gaps ? 3 : 1) + (has_gaps ? sizeof(GapHead) : 0);
  if (head.wide_count > source_->left() / sizeof(WideWord) ||
      least + head.wide_count * sizeof(WideWord) > source_->left())
    return InputError(fmt::format(
        "{}: is truncated: {} bytes follow its head, but {} x {} elements and {} large sums "
        "need more; {}",
        source_->name(), source_->left(), head.width, head.height, head.wide_count,
        kKind.if_broken));
  entries_ = std::move(front.entries);
  width_ = static_cast<int>(head.width);
  height_ = static_cast<int>(head.height);
  kind_ = *kind;
  rows_per_chunk_ = static_cast<int>(head.rows_per_chunk);
  wide_count_ = head.wide_count;
  has_gaps_ = has_gaps;
  return {};
}

Result<void> PlateReader::CheckEnds() const {
  if (source_->left() == 0) return {};
  return source_->Damaged(fmt::format("{} bytes follow its end", source_->left()));
}

Result<void> PlateReader::AddTo(SensorPlate* plate, const std::function<bool()>& is_interrupted) {
  LF_CHECK(plate->width() == width_ && plate->height() == height_ && plate->kind() == kind_);
  LF_RETURN_IF_ERROR(AddRays(0, wide_count_, plate, is_interrupted));
  return has_gaps_ ? Result<void>() : CheckEnds();
}

Result<void> PlateReader::AddGapsTo(PlateGaps* gaps, const std::function<bool()>& is_interrupted) {
  LF_CHECK(has_gaps_);
  GapHead head;
  LF_RETURN_IF_ERROR(source_->Read(&head, sizeof(head)));
  if (HashBytes({reinterpret_cast<const char*>(&head.wide_count), sizeof(head.wide_count)}) !=
      head.hash)
    return source_->Damaged("the checksum of the head of its gaps differs");
  const bool is_first = gaps->rays.width() == 0;
  if (is_first) {
    gaps->rays = SensorPlate(width_, height_, GapKindOf(kind_));
    gaps->share = Image<float>(width_, height_);
  }
  if (gaps->rays.width() != width_ || gaps->rays.height() != height_ ||
      gaps->rays.kind() != GapKindOf(kind_))
    return InputError(fmt::format("{}: has gaps of {} x {} elements, expected {} x {}",
                                  source_->name(), width_, height_, gaps->rays.width(),
                                  gaps->rays.height()));
  const auto count = static_cast<uint32_t>(chunk_count());
  LF_RETURN_IF_ERROR(AddRays(count, head.wide_count, &gaps->rays, is_interrupted));
  for (uint32_t chunk = 0; chunk < count; ++chunk) {
    if (is_interrupted && is_interrupted()) return Error{ErrorKind::kInterrupted, "interrupted"};
    const int y_begin = static_cast<int>(chunk) * rows_per_chunk_;
    LF_RETURN_IF_ERROR(ReadShares(2 * count + chunk, y_begin,
                                  std::min(height_, y_begin + rows_per_chunk_), !is_first,
                                  &gaps->share));
  }
  return CheckEnds();
}

// Adds the rays of a plate whose first chunk has this number.
Result<void> PlateReader::AddRays(uint32_t first_chunk, uint64_t wide_count, SensorPlate* plate,
                                  const std::function<bool()>& is_interrupted) {
  for (int chunk = 0; chunk < chunk_count(); ++chunk) {
    if (is_interrupted && is_interrupted()) return Error{ErrorKind::kInterrupted, "interrupted"};
    const int y_begin = chunk * rows_per_chunk_;
    LF_RETURN_IF_ERROR(AddChunk(first_chunk + static_cast<uint32_t>(chunk), y_begin,
                                std::min(height_, y_begin + rows_per_chunk_), plate));
  }
  return AddWide(wide_count, plate);
}

// Reads and unpacks a chunk of `size` bytes.
Result<std::vector<char>> PlateReader::ReadChunk(uint32_t number, int y_begin, int y_end,
                                                 size_t size) {
  ChunkHead head;
  LF_RETURN_IF_ERROR(source_->Read(&head, sizeof(head)));
  if (head.stored_bytes > ZSTD_compressBound(size) || head.reserved != 0)
    return source_->Damaged(fmt::format("rows {}-{}: {} stored bytes, at most {} were expected",
                                        y_begin, y_end - 1, head.stored_bytes,
                                        ZSTD_compressBound(size)));
  std::string stored(head.stored_bytes, '\0');
  LF_RETURN_IF_ERROR(source_->Read(stored.data(), stored.size()));
  if (HashBytes(stored, number) != head.hash)
    return source_->Damaged(fmt::format("the checksum of rows {}-{} differs", y_begin, y_end - 1));
  std::vector<char> planes(size);
  if (ZSTD_decompress(planes.data(), size, stored.data(), stored.size()) != size)
    return source_->Damaged(fmt::format("rows {}-{} cannot be unpacked", y_begin, y_end - 1));
  return planes;
}

Result<void> PlateReader::AddChunk(uint32_t number, int y_begin, int y_end, SensorPlate* plate) {
  const size_t row_words = static_cast<size_t>(width_) * static_cast<size_t>(plate->channels());
  std::vector<uint64_t> words(static_cast<size_t>(y_end - y_begin) * row_words);
  LF_ASSIGN_OR_RETURN(const std::vector<char> planes,
                      ReadChunk(number, y_begin, y_end, words.size() * sizeof(uint64_t)));
  FromPlanes(planes.data(), std::span(words));
  for (size_t i = 0; i < words.size(); ++i) {
    const ElementSum rays = {words[i] & SensorPlate::kSumMask, words[i] >> SensorPlate::kSumBits};
    if (rays.sum > 65535 * rays.count)
      return source_->Damaged(fmt::format("row {}: a sum of {} is more than {} rays can have",
                                          y_begin + static_cast<int>(i / row_words), rays.sum,
                                          rays.count));
    if (rays.count == 0) continue;
    const auto in_row = static_cast<int>(i % row_words);
    plate->Add(in_row / plate->channels(), y_begin + static_cast<int>(i / row_words),
               in_row % plate->channels(), rays);
  }
  return {};
}

// Reads the shares of some rows. If `compares` is true, *share has them already.
Result<void> PlateReader::ReadShares(uint32_t number, int y_begin, int y_end, bool compares,
                                     Image<float>* share) {
  std::vector<uint32_t> words(static_cast<size_t>(y_end - y_begin) * static_cast<size_t>(width_));
  LF_ASSIGN_OR_RETURN(const std::vector<char> planes,
                      ReadChunk(number, y_begin, y_end, words.size() * sizeof(uint32_t)));
  FromPlanes(planes.data(), std::span(words));
  for (size_t i = 0; i < words.size(); ++i) {
    const int x = static_cast<int>(i % static_cast<size_t>(width_));
    const int y = y_begin + static_cast<int>(i / static_cast<size_t>(width_));
    const auto read = std::bit_cast<float>(words[i]);
    if (!(read >= 0 && read <= 1))
      return source_->Damaged(fmt::format("row {}: {} is no share of a gap", y, read));
    float& known = share->at(x, y);
    if (compares && known != read)
      return InputError(fmt::format(
          "{}: the gaps of its lens have a share of {} in element ({}, {}), but {} in the plates "
          "before, so that another program has rendered it",
          source_->name(), read, x, y, known));
    known = read;
  }
  return {};
}

Result<void> PlateReader::AddWide(uint64_t wide_count, SensorPlate* plate) {
  const uint64_t row_words =
      static_cast<uint64_t>(width_) * static_cast<uint64_t>(plate->channels());
  const uint64_t word_count = row_words * static_cast<uint64_t>(height_);
  Hasher hasher;
  uint64_t next_index = 0;
  for (uint64_t done = 0; done < wide_count;) {
    std::vector<WideWord> block(std::min<uint64_t>(kWideBlock, wide_count - done));
    LF_RETURN_IF_ERROR(source_->Read(block.data(), block.size() * sizeof(WideWord)));
    hasher.Add({reinterpret_cast<const char*>(block.data()), block.size() * sizeof(WideWord)});
    for (const WideWord& word : block) {
      // Counts above 2^44, which no render reaches, are refused, so that adding plates cannot
      // overflow 64 bits.
      if (word.index < next_index || word.index >= word_count ||
          word.count <= SensorPlate::kMaxCount || word.count > uint64_t{1} << 44 ||
          word.sum > 65535 * word.count)
        return source_->Damaged(fmt::format("wide word {} (sum {}, count {}) is invalid",
                                            word.index, word.sum, word.count));
      next_index = word.index + 1;
      const auto in_row = static_cast<int>(word.index % row_words);
      plate->Add(in_row / plate->channels(), static_cast<int>(word.index / row_words),
                 in_row % plate->channels(), {word.sum, word.count});
    }
    done += block.size();
  }
  uint64_t hash = 0;
  LF_RETURN_IF_ERROR(source_->Read(&hash, sizeof(hash)));
  if (hash != hasher.Hash()) return source_->Damaged("the checksum of its wide words differs");
  return {};
}

}  // namespace lf
