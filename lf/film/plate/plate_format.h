// SPDX-License-Identifier: Apache-2.0
// The layout of a plate's file (doc/formats/plate.md), for its writer and reader. Internal to
// this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "lf/film/plate/entry_file.h"

namespace lf::plate_format {

inline constexpr entry_file::Kind kKind = {"LFPLATE\n", 3, "plate", "the plate cannot be used"};

// A plate's file begins with this head. The text of its entries follows, then the hash of both.
struct Head {
  char magic[8];
  uint32_t version;
  uint32_t text_bytes;
  uint32_t width;
  uint32_t height;
  uint32_t channels;
  uint32_t rows_per_chunk;
  uint64_t wide_count;
};
static_assert(sizeof(Head) == 40);

// Head of a chunk. The packed words of some rows of the plate follow it, compressed; a word whose
// content is a WideWord is 0.
struct ChunkHead {
  uint32_t stored_bytes;
  uint32_t reserved;  // always 0
  uint64_t hash;      // XXH3 of the stored bytes, seeded by the number of the chunk
};
static_assert(sizeof(ChunkHead) == 16);

// A sum and count that do not fit in a packed word (sensor_plate.h), and the index of that word.
// The wide words follow the chunks, by ascending index. The XXH3 of all wide words ends the file.
struct WideWord {
  uint64_t index;
  uint64_t sum;
  uint64_t count;
};
static_assert(sizeof(WideWord) == 24);
inline constexpr size_t kWideBlock = 4096;  // number of wide words that are read at once

// A chunk holds about this number of words, in whole rows.
inline constexpr size_t kChunkWords = size_t{1} << 16;

// Writes the first byte of all words, then the second byte of all words, and so on. Bytes that
// hardly differ are then neighbours, which more than doubles the speed of compression
// (doc/formats/plate.md).
inline void ToPlanes(std::span<const uint64_t> words, char* planes) {
  for (int byte = 0; byte < 8; ++byte)
    for (size_t i = 0; i < words.size(); ++i)
      planes[static_cast<size_t>(byte) * words.size() + i] =
          static_cast<char>(words[i] >> (8 * byte));
}

inline void FromPlanes(const char* planes, std::span<uint64_t> words) {
  for (uint64_t& word : words) word = 0;
  for (int byte = 0; byte < 8; ++byte)
    for (size_t i = 0; i < words.size(); ++i)
      words[i] |= static_cast<uint64_t>(static_cast<unsigned char>(
                      planes[static_cast<size_t>(byte) * words.size() + i]))
                  << (8 * byte);
}

}  // namespace lf::plate_format
