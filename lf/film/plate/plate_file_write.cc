// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <new>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/film/plate/entry_file.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/plate_format.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using namespace plate_format;

// Level of zstd. Measured on plates of 1280 x 960 elements: level 1 compresses 1.25 GB/s to a sixth
// of the bytes; level 3 takes a third longer and writes 3 % less.
constexpr int kCompressionLevel = 1;

// Returns true if a sum is written as a wide word, because its count does not fit in a packed word.
// The plate itself may store a sum in either word, depending on how it was filled; the file must
// not depend on that.
bool IsWide(const ElementSum& rays) { return rays.count > SensorPlate::kMaxCount; }

// Returns words as a chunk: its ChunkHead, then the compressed words.
template <class Word>
std::string ChunkOf(uint32_t number, std::span<const Word> words) {
  const size_t size = words.size_bytes();
  std::vector<char> planes(size);
  ToPlanes(words, planes.data());
  std::string chunk(sizeof(ChunkHead) + ZSTD_compressBound(size), '\0');
  const size_t stored = ZSTD_compress(chunk.data() + sizeof(ChunkHead), ZSTD_compressBound(size),
                                      planes.data(), size, kCompressionLevel);
  if (ZSTD_isError(stored) != 0) throw std::bad_alloc();  // other errors need a smaller buffer
  const ChunkHead head = {static_cast<uint32_t>(stored), 0,
                          HashBytes({chunk.data() + sizeof(head), stored}, number)};
  std::memcpy(chunk.data(), &head, sizeof(head));
  chunk.resize(sizeof(head) + stored);
  return chunk;
}

class Compressor {
 public:
  explicit Compressor(const SensorPlate& plate) : plate_(plate) {}

  // Returns the plate's words [begin, end) as a chunk.
  std::string Chunk(uint32_t number, size_t begin, size_t end) const {
    std::vector<uint64_t> words(plate_.words().begin() + static_cast<ptrdiff_t>(begin),
                                plate_.words().begin() + static_cast<ptrdiff_t>(end));
    for (auto wide = plate_.wide().lower_bound(begin);
         wide != plate_.wide().end() && wide->first < end; ++wide) {
      const ElementSum rays = plate_.AtWord(wide->first);
      words[wide->first - begin] = IsWide(rays) ? 0 : rays.count * SensorPlate::kOneRay + rays.sum;
    }
    return ChunkOf(number, std::span<const uint64_t>(words));
  }

 private:
  const SensorPlate& plate_;
};

std::vector<WideWord> WideWordsOf(const SensorPlate& plate) {
  std::vector<WideWord> wide;
  for (const auto& [index, unused] : plate.wide())
    if (const ElementSum rays = plate.AtWord(index); IsWide(rays))
      wide.push_back({index, rays.sum, rays.count});
  return wide;
}

// Writes chunks of `row_words` words in each row. `chunk_of` returns the words [begin, end) as the
// chunk of this number.
class ChunkWriter {
 public:
  ChunkWriter(entry_file::OutputFile* file, size_t rows, size_t chunk_rows, ThreadPool& pool)
      : file_(file), rows_(rows), chunk_rows_(chunk_rows), pool_(pool) {}

  void Write(
      size_t row_words,
      const std::function<std::string(uint32_t number, size_t begin, size_t end)>& chunk_of) {
    const size_t word_count = rows_ * row_words, chunk_words = chunk_rows_ * row_words;
    const size_t chunk_count = chunk_words == 0 ? 0 : (word_count + chunk_words - 1) / chunk_words;
    // Only a few chunks are compressed at a time, to save memory.
    const size_t together = 2 * static_cast<size_t>(pool_.thread_count());
    for (size_t first = 0; first < chunk_count; first += together) {
      std::vector<std::string> chunks(std::min(together, chunk_count - first));
      pool_.ForEach(chunks.size(), [&](size_t i) {
        const size_t begin = (first + i) * chunk_words;
        chunks[i] = chunk_of(first_number_ + static_cast<uint32_t>(first + i), begin,
                             std::min(word_count, begin + chunk_words));
      });
      for (const std::string& chunk : chunks) file_->Write(chunk);
    }
    first_number_ += static_cast<uint32_t>(chunk_count);
  }

  void WriteRays(const SensorPlate& plate, std::span<const WideWord> wide) {
    const Compressor compressor(plate);
    Write(static_cast<size_t>(plate.width()) * plate.channels(),
          [&](uint32_t number, size_t begin, size_t end) {
            return compressor.Chunk(number, begin, end);
          });
    const uint64_t hash =
        HashBytes({reinterpret_cast<const char*>(wide.data()), wide.size_bytes()});
    file_->Write(wide.data(), wide.size_bytes());
    file_->Write(&hash, sizeof(hash));
  }

 private:
  entry_file::OutputFile* const file_;
  const size_t rows_;
  const size_t chunk_rows_;
  ThreadPool& pool_;
  uint32_t first_number_ = 0;  // of the next chunk
};

void WriteGaps(const PlateGaps& gaps, entry_file::OutputFile* file, ChunkWriter* chunks) {
  const std::vector<WideWord> wide = WideWordsOf(gaps.rays);
  GapHead head = {wide.size(), 0};
  head.hash = HashBytes({reinterpret_cast<const char*>(&head.wide_count), sizeof(head.wide_count)});
  file->Write(&head, sizeof(head));
  chunks->WriteRays(gaps.rays, wide);
  chunks->Write(static_cast<size_t>(gaps.share.width()),
                [&gaps](uint32_t number, size_t begin, size_t end) {
                  std::vector<uint32_t> words(end - begin);
                  for (size_t i = begin; i < end; ++i)
                    words[i - begin] = std::bit_cast<uint32_t>(gaps.share.pixels()[i]);
                  return ChunkOf(number, std::span<const uint32_t>(words));
                });
}

Result<void> Write(const fs::path& path, const PlateEntries& entries, const SensorPlate& plate,
                   ThreadPool& pool, const PlateGaps* gaps) {
  const size_t row_words = static_cast<size_t>(plate.width()) * plate.channels();
  const size_t chunk_rows = std::max<size_t>(1, kChunkWords / std::max<size_t>(1, row_words));
  const std::vector<WideWord> wide = WideWordsOf(plate);
  Head head = {};
  head.width = static_cast<uint32_t>(plate.width());
  head.height = static_cast<uint32_t>(plate.height());
  head.channels = static_cast<uint32_t>(plate.channels());
  head.rows_per_chunk = static_cast<uint32_t>(chunk_rows);
  head.wide_count = wide.size();
  entry_file::Kind kind = kKind;
  kind.version = gaps == nullptr ? kVersion : kVersionWithGaps;
  entry_file::OutputFile file(path);
  file.Write(entry_file::FrontOf(
      kind, std::string(reinterpret_cast<const char*>(&head), sizeof(head)), entries));
  ChunkWriter chunks(&file, static_cast<size_t>(plate.height()), chunk_rows, pool);
  chunks.WriteRays(plate, wide);
  if (gaps != nullptr) WriteGaps(*gaps, &file, &chunks);
  return file.Close();
}

}  // namespace

Result<void> WritePlate(const fs::path& path, const PlateEntries& entries, const SensorPlate& plate,
                        ThreadPool& pool, const PlateGaps* gaps) {
  LF_CHECK(gaps == nullptr ||
           (gaps->rays.width() == plate.width() && gaps->rays.height() == plate.height() &&
            gaps->rays.kind() == GapKindOf(plate.kind()) && gaps->share.width() == plate.width() &&
            gaps->share.height() == plate.height()));
  return WriteAtomically(path, [&](const fs::path& temporary) {
    return Write(temporary, entries, plate, pool, gaps);
  });
}

}  // namespace lf
