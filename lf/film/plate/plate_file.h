// SPDX-License-Identifier: Apache-2.0
// A sensor plate as a file: what it was made from, its progress, and every sum and count, exact,
// with the gaps of the frame's lenses if it is a hybrid (doc/formats/plate.md). The plates of a
// divided render are read from such files and added, and an interrupted frame is resumed from such
// a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

namespace entry_file {
class Source;
}

// Keys and values that describe the plate, in the order in which its file holds them. Keys are
// words of [a-z0-9_.], and none occurs twice; values have no control characters.
using PlateEntries = std::vector<std::pair<std::string, std::string>>;

// Returns the value of a key; null if no entry has this key.
const std::string* FindEntry(const PlateEntries& entries, std::string_view key);

// The gaps of a frame's lenses: the parts that no collected ray passes near, which rays of kept
// pixels complete (render/hybrid/gap_lens.h, film/develop/completion.h). The rays of the shards of
// a frame add like those of its plate; the shares are the same in all shards.
struct PlateGaps {
  // Rays of the gaps: colours, and the opacity if the plate of the frame has one. 0 x 0: not read.
  SensorPlate rays{0, 0};
  Image<float> share;  // [height][width] share of the gaps in an element, in [0, 1]
};

// Writes the plate atomically (core/file.h), compressed by the threads of `pool`. The bytes depend
// on the sums, counts, shares and entries alone, not on how the plate stores them, and not on the
// threads. kOutput if the folder or the disk fails.
//   gaps  the gaps of the frame's lenses; null: the file has none
Result<void> WritePlate(const std::filesystem::path& path, const PlateEntries& entries,
                        const SensorPlate& plate, ThreadPool& pool,
                        const PlateGaps* gaps = nullptr);

// Reads a plate's file in two steps: first its entries, then, if the caller wants the plate, its
// rays.
class PlateReader {
 public:
  static constexpr uint32_t kMaxSide = 1u << 16;       // largest width and height, in elements
  static constexpr uint32_t kMaxTextBytes = 1u << 20;  // largest size of the entries as text

  // Opens a file and reads its head and entries. kInput if the file cannot be read, is no plate,
  // has another version, is too large, or is damaged; the message names file and reason.
  static Result<PlateReader> Open(const std::filesystem::path& path);
  // As Open(), for a file in memory, which must outlive the reader; messages call it `name`.
  static Result<PlateReader> OpenBytes(std::string_view bytes, const std::string& name);
  PlateReader(PlateReader&&) noexcept;
  PlateReader& operator=(PlateReader&&) noexcept;
  ~PlateReader();

  int width() const { return width_; }
  int height() const { return height_; }
  PlateKind kind() const { return kind_; }
  bool has_gaps() const { return has_gaps_; }
  const PlateEntries& entries() const { return entries_; }

  // Adds all rays to a plate of the file's size and kind. Takes about a megabyte of memory
  // beside the plate. Must be called only once. kInput if the file is truncated or damaged; the
  // plate then holds a part of the rays and must not be used. kInterrupted, with such a plate:
  // is_interrupted, which is called every few rows and may be empty, returned true.
  Result<void> AddTo(SensorPlate* plate, const std::function<bool()>& is_interrupted = {});
  // Adds the rays of the gaps, and sets the shares, if gaps->rays is 0 x 0; otherwise adds the rays
  // and compares the shares. Must be called at most once, after AddTo(), and only if has_gaps() is
  // true. kInput and kInterrupted: as for AddTo(). kInput: the shares differ from those in `gaps`,
  // or the sizes do.
  Result<void> AddGapsTo(PlateGaps* gaps, const std::function<bool()>& is_interrupted = {});

 private:
  explicit PlateReader(std::unique_ptr<entry_file::Source> source);
  Result<void> ReadHead();
  int chunk_count() const { return (height_ - 1) / rows_per_chunk_ + 1; }
  Result<void> AddRays(uint32_t first_chunk, uint64_t wide_count, SensorPlate* plate,
                       const std::function<bool()>& is_interrupted);
  Result<std::vector<char>> ReadChunk(uint32_t number, int y_begin, int y_end, size_t size);
  Result<void> AddChunk(uint32_t number, int y_begin, int y_end, SensorPlate* plate);
  Result<void> AddWide(uint64_t wide_count, SensorPlate* plate);
  Result<void> ReadShares(uint32_t number, int y_begin, int y_end, bool compares,
                          Image<float>* share);
  Result<void> CheckEnds() const;

  std::unique_ptr<entry_file::Source> source_;
  int width_ = 0;
  int height_ = 0;
  PlateKind kind_ = PlateKind::kColours;
  int rows_per_chunk_ = 1;
  uint64_t wide_count_ = 0;
  bool has_gaps_ = false;
  PlateEntries entries_;
};

}  // namespace lf
