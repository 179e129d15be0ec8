// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <new>

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

class Compressor {
 public:
  explicit Compressor(const SensorPlate& plate) : plate_(plate) {}

  // Returns the plate's words [begin, end) as a chunk: its ChunkHead, then the compressed words.
  std::string Chunk(uint32_t number, size_t begin, size_t end) const {
    std::vector<uint64_t> words(plate_.words().begin() + static_cast<ptrdiff_t>(begin),
                                plate_.words().begin() + static_cast<ptrdiff_t>(end));
    for (auto wide = plate_.wide().lower_bound(begin);
         wide != plate_.wide().end() && wide->first < end; ++wide) {
      const ElementSum rays = plate_.AtWord(wide->first);
      words[wide->first - begin] = IsWide(rays) ? 0 : rays.count * SensorPlate::kOneRay + rays.sum;
    }
    const size_t size = words.size() * sizeof(uint64_t);
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

 private:
  const SensorPlate& plate_;
};

Result<void> Write(const fs::path& path, const PlateEntries& entries, const SensorPlate& plate,
                   ThreadPool& pool) {
  const size_t row_words = static_cast<size_t>(plate.width()) * plate.channels();
  const size_t chunk_rows = std::max<size_t>(1, kChunkWords / std::max<size_t>(1, row_words));
  std::vector<WideWord> wide;
  for (const auto& [index, unused] : plate.wide())
    if (const ElementSum rays = plate.AtWord(index); IsWide(rays))
      wide.push_back({index, rays.sum, rays.count});

  Head head = {};
  head.width = static_cast<uint32_t>(plate.width());
  head.height = static_cast<uint32_t>(plate.height());
  head.channels = static_cast<uint32_t>(plate.channels());
  head.rows_per_chunk = static_cast<uint32_t>(chunk_rows);
  head.wide_count = wide.size();
  entry_file::OutputFile file(path);
  file.Write(entry_file::FrontOf(
      kKind, std::string(reinterpret_cast<const char*>(&head), sizeof(head)), entries));

  const Compressor compressor(plate);
  const size_t word_count = plate.words().size(), chunk_words = chunk_rows * row_words;
  const size_t chunk_count = chunk_words == 0 ? 0 : (word_count + chunk_words - 1) / chunk_words;
  // Only a few chunks are compressed at a time, to save memory.
  const size_t together = 2 * static_cast<size_t>(pool.thread_count());
  for (size_t first = 0; first < chunk_count; first += together) {
    std::vector<std::string> chunks(std::min(together, chunk_count - first));
    pool.ForEach(chunks.size(), [&](size_t i) {
      const size_t begin = (first + i) * chunk_words;
      chunks[i] = compressor.Chunk(static_cast<uint32_t>(first + i), begin,
                                   std::min(word_count, begin + chunk_words));
    });
    for (const std::string& chunk : chunks) file.Write(chunk);
  }
  const size_t wide_bytes = wide.size() * sizeof(WideWord);
  const uint64_t wide_hash = HashBytes({reinterpret_cast<const char*>(wide.data()), wide_bytes});
  file.Write(wide.data(), wide_bytes);
  file.Write(&wide_hash, sizeof(wide_hash));
  return file.Close();
}

}  // namespace

Result<void> WritePlate(const fs::path& path, const PlateEntries& entries, const SensorPlate& plate,
                        ThreadPool& pool) {
  return WriteAtomically(
      path, [&](const fs::path& temporary) { return Write(temporary, entries, plate, pool); });
}

}  // namespace lf
