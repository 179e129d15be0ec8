// SPDX-License-Identifier: Apache-2.0
// The layout of a plate's file (doc/formats/plate.md), for its writer and reader. Internal to
// this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "lf/film/plate/entry_file.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf::plate_format {

// Version of a plate alone, and of a plate that the gaps of its lenses follow.
inline constexpr uint32_t kVersion = 3;
inline constexpr uint32_t kVersionWithGaps = 4;
inline constexpr entry_file::Kind kKind = {"LFPLATE\n", kVersion, "plate",
                                           "the plate cannot be used", kVersionWithGaps};

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

// Head of the gaps, which follow the plate in a file of kVersionWithGaps. The chunks of their rays
// follow it, with as many rows each as the chunks of the plate, then the wide words of these rays
// and the XXH3 of these words, and then chunks of the same rows with the shares: one float for each
// element, as a word of 32 bits. The numbers of all these chunks continue those of the plate.
struct GapHead {
  uint64_t wide_count;
  uint64_t hash;  // XXH3 of wide_count
};
static_assert(sizeof(GapHead) == 16);

// Returns the kind of the plate of the gaps.
inline PlateKind GapKindOf(PlateKind kind) {
  const bool has_opacity = kind == PlateKind::kOpacity || kind == PlateKind::kGuardedOpacity;
  return has_opacity ? PlateKind::kOpacity : PlateKind::kColours;
}

// A chunk holds about this number of words, in whole rows.
inline constexpr size_t kChunkWords = size_t{1} << 16;

// Writes the first byte of all words, then the second byte of all words, and so on. Bytes that
// hardly differ are then neighbours, which more than doubles the speed of compression
// (doc/formats/plate.md).
template <class Word>
void ToPlanes(std::span<const Word> words, char* planes) {
  for (size_t byte = 0; byte < sizeof(Word); ++byte)
    for (size_t i = 0; i < words.size(); ++i)
      planes[byte * words.size() + i] = static_cast<char>(words[i] >> (8 * byte));
}

template <class Word>
void FromPlanes(const char* planes, std::span<Word> words) {
  for (Word& word : words) word = 0;
  for (size_t byte = 0; byte < sizeof(Word); ++byte)
    for (size_t i = 0; i < words.size(); ++i)
      words[i] |= static_cast<Word>(static_cast<unsigned char>(planes[byte * words.size() + i]))
                  << (8 * byte);
}

}  // namespace lf::plate_format
